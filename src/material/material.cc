#include "lobefit/material/material.h"

namespace lobefit {

ParameterValues Material::Values() const {
  ParameterValues values;
  for (const FittedParameter& parameter : parameters) values.push_back(parameter.values);
  return values;
}

}  // namespace lobefit
