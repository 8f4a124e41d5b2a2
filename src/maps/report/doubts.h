// Signs that a stack is not what it is taken for: a wrong encoding, near lights taken as distant.
#pragma once

#include <string>
#include <vector>

#include "lobefit/maps/engine/descent.h"
#include "lobefit/maps/engine/shape.h"
#include "lobefit/maps/relight.h"

namespace lobefit {

struct Estimate {
  double value = 0, error = 0;  // standard, texels taken as independent
};

// Each is one number for the whole stack, to first order about the fit: by what of its effect on the values of a texel
// no change of the texel's own numbers can meet.
struct StackDoubts {
  Estimate exponent;  // of the photographs over the fit, less 1: 0 where the encoding is right
  Estimate nearness;  // 1 / distance of the lights in widths of the picture: 0 for distant ones
  double bend = 0;    // mean angle, radians, by which a nearness of 1 bends the fitted normals

  // In words, what is significant and large enough to matter; empty: nothing.
  std::vector<std::string> Remarks() const;
};

// Gathers them texel by texel.
class DoubtMeter {
 public:
  // Unit directions of the lights that were fitted.
  DoubtMeter(std::vector<Vec3> lights, bool schlick, int channels);
  // `values`: of those lights, summed over channels; NaN or infinite: none. `x`, `y`: from the picture's middle, in its
  // widths. Texels that are hidden are passed over.
  void Add(const std::vector<double>& values, const RelitTexel& texel, double x, double y);
  StackDoubts Result() const;

 private:
  // A regression with one sum a texel.
  struct Pool {
    std::vector<double> xy, xx;
    Estimate Slope() const;
  };
  // Values of the texel under lights at distance 1 / nearness.
  void Predict(const RelitTexel& texel, double x, double y, double nearness, bool gradient,
               std::vector<double>* values);
  void MakeColumns(const RelitTexel& texel);
  // What of `change` the columns do not meet stays in it; the coefficients of the normal's two turns.
  bool Project(std::vector<double>* change, double turns[2]) const;

  std::vector<Vec3> directions_;
  bool schlick_;
  std::size_t channels_;
  LightArrays lights_;
  ShapeArrays shape_;
  std::vector<std::vector<double>> columns_;
  std::vector<double> weights_;
  MapMatrix factor_ = {};
  Pool exponent_, nearness_;
  double bend_ = 0;
};

}  // namespace lobefit
