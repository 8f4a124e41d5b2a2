// Layouts by name: which pairs of directions a synthetic measurement holds.
#pragma once

#include <string>
#include <vector>

#include "lobefit/synthesis/synthesis.h"
#include "lobefit/validate/truth.h"

namespace lobefit {

struct LayoutRequest {
  // A name of LayoutChoices(), or a measurement file whose directions are taken.
  std::string name = "goniometer";
  // Light and detector of the layouts that leave them open.
  GoniometerLayout goniometer;
  // Samples an incidence of `visible-normals` and `rgl`, about.
  std::size_t samples = 256;
};

struct LayoutChoice {
  const char* name;
  const char* description;
};
const std::vector<LayoutChoice>& LayoutChoices();

struct MeasurementLayout {
  DirectionList directions;
  bool isotropic = false;  // it cannot express a dependence on azimuth
  // Smallest step between neighbouring samples of one incidence, radians: an aperture wider than it blurs what the grid
  // resolves.
  double step = 0;
};

// Some layouts place samples by the truth's first lobe. Throws UsageError for an unknown name (with the allowed ones)
// and for an isotropic layout of an anisotropic truth, InputError for a file that cannot be read.
MeasurementLayout MakeLayout(const LayoutRequest& request, const Truth& truth);

// Throws UsageError where a disc is wider than kMostSteps of the layout's steps (fit/instrument.h), as a fit does.
// Discs that overlap are what an instrument with a fine drive measures.
void RequireApertureWithin(const MeasurementLayout& layout, const Noise& noise);

}  // namespace lobefit
