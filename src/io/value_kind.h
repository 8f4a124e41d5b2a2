// What a file's numbers are, by name and as the factor that turns them into f_r: see options.h.
#pragma once

#include "lobefit/io/options.h"
