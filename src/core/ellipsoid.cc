#include "lobefit/core/ellipsoid.h"
