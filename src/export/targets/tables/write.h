// The targets that are tables of f_r, by the writers of src/io, and the native document.
#pragma once

#include <string>

#include "lobefit/export/targets/target.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

WrittenFiles WriteJsonTarget(const FittedBrdf& fit, const WriteContext& context);
// Samples over a goniometer's directions.
WrittenFiles WriteCsvTarget(const FittedBrdf& fit, const WriteContext& context);
// NAME_rgb.bsdf (Mitsuba's rgb variants) and NAME_spec.bsdf (pbrt-v4, Mitsuba's spectral variants). R G B become a
// smooth spectrum of 11 wavelengths whose R G B are these; of more than 32 wavelengths every k-th is kept.
WrittenFiles WriteRglTarget(const FittedBrdf& fit, const WriteContext& context);
WrittenFiles WriteMerlTarget(const FittedBrdf& fit, const WriteContext& context);
WrittenFiles WriteBsdfXmlTarget(const FittedBrdf& fit, const WriteContext& context);

// "" or why a MERL table cannot hold the fit.
std::string RefuseMerl(const FittedBrdf& fit);
// "" or that the channels cannot become R, G, B or a spectrum.
std::string RefuseRgl(const FittedBrdf& fit);

}  // namespace lobefit
