// Where descents begin: a grid of shapes judged on a small subsample with the linear parameters solved for, not
// searched.
#pragma once

#include <cstdint>
#include <vector>

#include "lobefit/fit/coordinates/coordinates.h"
#include "lobefit/fit/objective/problem.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

struct Start {
  std::vector<double> u;
  double cost = 0;  // on the subsample
};

// Indices of a stratified subsample of about `count` samples: one from each of `count` equal runs of the file's order,
// at a place drawn by `seed`. All indices where there are no more than `count`.
std::vector<std::size_t> StratifiedSubsample(std::size_t samples, std::size_t count, std::uint64_t seed);

// Candidate shapes for one lobe: alphas from narrow to broad; for models that tilt, around the normal and around the
// half vector where the measured density of normals peaks; for anisotropic ones, four orientations.
std::vector<Ellipsoid> CandidateShapes(const Samples& samples, Ndf ndf, double plane_azimuth);

// A shape with alphas 1 whose axis points to where the measured density of half vectors peaks; for lobes in the plane
// the part of that within the plane.
Ellipsoid PeakAxis(const Samples& samples, Ndf ndf, double plane_azimuth);

// Weights that turn the squared differences of f cos_theta_i (of f for the relative metric) into the metric's, to first
// order about the measured values: (dT/dv)^2 at the measured v, times the samples' own and those of stated
// uncertainties.
std::vector<double> LinearisedWeights(const Samples& samples, Metric metric, const NoiseModel& noise);

// Best amplitudes and albedos for the shapes in `u`, in place, within their bounds: Gauss-Newton on the linear
// parameters only, one step (exact where the metric is quadratic in f_r). Returns the cost before the step.
double StepLinear(const Problem& problem, const Layout& layout, std::vector<double>* u, ThreadPool* pool);

// Candidates (for several lobes, ordered tuples of them), best first, with their linear parameters solved for: all, but
// of many channels only those from which the `wanted` best come.
std::vector<Start> RankedStarts(const Problem& problem, const Layout& layout, const Samples& samples,
                                std::size_t wanted, ThreadPool* pool);

}  // namespace lobefit
