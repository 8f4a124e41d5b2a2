// The targets of an export: what each can hold of a fit, and how it is written.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/export/targets/imported_material.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// How a target carries a feature of the fit.
enum class Carries { kExactly, kApproximately, kNot };
struct Carried {
  std::string feature;
  Carries how = Carries::kExactly;
  std::string note;  // in which form, or what becomes of it
};

// Where and with which comments files are written.
struct WriteContext {
  std::filesystem::path folder;
  std::string name;                 // of the material; files are NAME and an ending
  std::vector<std::string> header;  // lines of the comment at the top of text files
  int threads = 1;
  // Reads a written file back as its renderer evaluates it.
  std::function<ImportedMaterial(const std::filesystem::path&)> read_back;

  std::filesystem::path File(std::string_view ending) const { return folder / (name + std::string(ending)); }
};

struct WrittenFiles {
  std::vector<std::filesystem::path> files;
  // The target's f_r in the fit's channels, from the written file where it can be read back.
  BrdfFunction brdf;
  bool exact = false;              // the file evaluates the model itself
  std::vector<std::string> notes;  // for people: what to do beside loading the file
};

struct Target {
  const char* name;
  const char* description;
  const char* load;  // one line: how to load it
  // Why the target cannot hold this fit at all; empty where it can.
  std::string (*refusal)(const FittedBrdf& fit);
  std::vector<Carried> (*carries)(const FittedBrdf& fit);
  // The model nearest to the target's own among those that can be fitted; null: numbers are never refitted.
  Model (*own_model)(const FittedBrdf& fit);
  // The target's own model with the numbers of `fit` translated: f_r in the fit's channels. Null where `write` has it.
  BrdfFunction (*evaluate)(const FittedBrdf& fit);
  WrittenFiles (*write)(const FittedBrdf& fit, const WriteContext& context);
  // A table of squared ellipsoidal lobes in place of a model; null: the target cannot hold one.
  WrittenFiles (*write_sel)(const Material& material, const WriteContext& context) = nullptr;
};

// A function of R, G, B as one of the fit's channels: itself, or its first channel where the fit has one.
BrdfFunction InChannelsOf(const FittedBrdf& fit, const BrdfFunction& rgb);

}  // namespace lobefit
