#include "lobefit/validate/trial_store.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/version.h"
#include "lobefit/material/json.h"
#include "lobefit/math/vec.h"

namespace lobefit {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity, which degrees of freedom may be.
Json TrialNumber(double v) {
  constexpr double kMost = std::numeric_limits<double>::max();
  return std::isnan(v) ? Json(nullptr) : Json(std::clamp(v, -kMost, kMost));
}

Json Numbers(const std::vector<double>& values) {
  Json numbers = Json::array();
  for (const double v : values) numbers.push_back(TrialNumber(v));
  return numbers;
}

double NumberOf(const Json& json) { return json.is_null() ? kNan : json.get<double>(); }

std::vector<double> NumbersOf(const Json& json) {
  std::vector<double> values;
  for (const Json& v : json) values.push_back(NumberOf(v));
  return values;
}

Trial TrialOf(const Json& line) {
  Trial trial;
  trial.done = true;
  trial.error = line.at("error").get<std::string>();
  trial.truth = NumbersOf(line.at("truth"));
  trial.value = NumbersOf(line.at("value"));
  trial.standard_error = NumbersOf(line.at("stderr"));
  trial.standard_error_clustered = NumbersOf(line.at("stderr_clustered"));
  trial.freedom = NumbersOf(line.at("freedom"));
  trial.independent_freedom = NumbersOf(line.at("stderr_freedom"));
  trial.free = line.at("free").get<std::vector<bool>>();
  trial.at_bound = line.at("at_bound").get<std::vector<bool>>();
  trial.converged = line.at("converged").get<bool>();
  trial.determined = line.at("determined").get<bool>();
  trial.degenerate = line.at("degenerate").get<std::vector<std::string>>();
  trial.cost = NumberOf(line.at("cost"));
  trial.cost_at_truth = NumberOf(line.at("cost_at_truth"));
  trial.difference = NumberOf(line.at("difference"));
  trial.minima = line.at("minima").get<std::size_t>();
  trial.samples = line.at("samples").get<std::size_t>();
  trial.incidences = line.at("incidences").get<std::size_t>();
  trial.misfit = line.at("misfit").get<bool>();
  trial.biased = line.at("biased").get<bool>();
  trial.seconds = NumberOf(line.at("seconds"));
  return trial;
}

std::filesystem::path SegmentsOf(const std::filesystem::path& folder) {
  const std::filesystem::path segments = folder / "segments";
  MakeFolder(segments);
  return segments;
}

}  // namespace

std::string KeyOf(const Experiment& experiment) {
  std::string text = fmt::format("lobefit {}\n{}\n{}\n{}\nseed {} starts {} isotropic {} drawn {} turned {}\n",
                                 Version(), ToJson(MaterialOf(experiment.truth)), ToText(experiment.noise),
                                 ToToml(experiment.recipe), experiment.seed, experiment.fit.starts,
                                 experiment.isotropic, experiment.range.has_value(), experiment.turned);
  // The numbers themselves, not as text, which would take 200 bytes a pair.
  for (const std::vector<Vec3>* side : {&experiment.directions.wi, &experiment.directions.wo})
    text += Sha256Hex({reinterpret_cast<const char*>(side->data()), side->size() * sizeof(Vec3)});
  return Sha256Hex(text);
}

TrialStore::TrialStore(const std::filesystem::path& folder, std::string key)
    : folder_(SegmentsOf(folder)), key_(std::move(key)), journal_(folder_) {}

std::vector<Trial> TrialStore::Read(std::size_t count) const {
  std::vector<Trial> trials(count);
  std::vector<std::filesystem::path> segments;
  for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder_)) {
    if (entry.path().extension() == ".jsonl") segments.push_back(entry.path());
  }
  std::sort(segments.begin(), segments.end());
  for (const std::filesystem::path& segment : segments) {
    std::ifstream file(segment);
    for (std::string text; std::getline(file, text);) {
      // The first line of a segment says who writes.
      const Json line = Json::parse(text, nullptr, false);
      if (!line.is_object() || !line.contains("trial") || !line.contains("key")) continue;
      if (line.at("key") != key_) {
        throw UsageError(fmt::format(
            "{}: holds trials of another validation or version of lobefit; give the same source and options again, or "
            "choose another --out",
            PrintableName(segment.string())));
      }
      try {
        const auto index = line.at("trial").get<std::size_t>();
        if (index < count) trials[index] = TrialOf(line);
      } catch (const Json::exception&) {
        // Not a line of Append: the trial is not done.
      }
    }
  }
  return trials;
}

void TrialStore::Append(std::size_t index, const Trial& trial) { journal_.Commit(ToLine(key_, index, trial), {}); }

void TrialStore::Close() { journal_.Close(); }

std::string ToLine(const std::string& key, std::size_t index, const Trial& trial) {
  const Json line = {{"key", key},
                     {"trial", index},
                     {"error", trial.error},
                     {"truth", Numbers(trial.truth)},
                     {"value", Numbers(trial.value)},
                     {"stderr", Numbers(trial.standard_error)},
                     {"stderr_clustered", Numbers(trial.standard_error_clustered)},
                     {"freedom", Numbers(trial.freedom)},
                     {"stderr_freedom", Numbers(trial.independent_freedom)},
                     {"free", trial.free},
                     {"at_bound", trial.at_bound},
                     {"converged", trial.converged},
                     {"determined", trial.determined},
                     {"degenerate", trial.degenerate},
                     {"cost", TrialNumber(trial.cost)},
                     {"cost_at_truth", TrialNumber(trial.cost_at_truth)},
                     {"difference", TrialNumber(trial.difference)},
                     {"minima", trial.minima},
                     {"samples", trial.samples},
                     {"incidences", trial.incidences},
                     {"misfit", trial.misfit},
                     {"biased", trial.biased},
                     {"seconds", TrialNumber(trial.seconds)}};
  return line.dump(-1, ' ', true, Json::error_handler_t::replace);
}

}  // namespace lobefit
