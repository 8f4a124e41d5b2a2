// What was fitted, as a function of both directions: a model of the surface, or a table of squared ellipsoidal lobes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lobefit/core/brdf/brdf.h"
#include "lobefit/core/sel/sel_table.h"
#include "lobefit/material/material.h"

namespace lobefit {

class FittedFunction {
 public:
  explicit FittedFunction(const Material& material);

  std::size_t channels() const { return model_.channels(); }
  // Of a model; a table has none.
  const std::vector<SlopeCoordinates>& lobe_shapes() const { return model_.lobe_shapes(); }
  const std::vector<LobeShape>& shapes() const { return model_.shapes(); }
  // Null for a model.
  const SelReflectance* table() const { return table_ ? &*table_ : nullptr; }

  // f_r[c], 1/sr, for unit directions; 0 where one of them is at or below the horizon.
  void Evaluate(const Vec3& wi, const Vec3& wo, double* f_r) const;
  // The same for many: (*f_r)[c][i].
  void Evaluate(const DirectionArrays& directions, std::vector<std::vector<double>>* f_r) const;

 private:
  Reflectance model_;
  std::optional<SelReflectance> table_;
};

}  // namespace lobefit
