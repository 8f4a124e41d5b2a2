// The targets of an export: what each can hold of a fit, how it is written, and how its files are read.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/export/targets/imported_material.h"
#include "lobefit/io/text/format.h"
#include "lobefit/measurement/brdf_function.h"
#include "lobefit/renderer/fitted_brdf.h"

namespace lobefit {

// What a fit consists of; the normal of maps alone, the last three of a table of lobes.
enum class Feature {
  kShape,
  kRotation,
  kTilt,
  kNormal,
  kMasking,
  kFresnel,
  kDiffuse,
  kSecondLobe,
  kCoat,
  kChannels,
  kLobes,
  kInterpolation,
  kBound,
};
const char* NameOf(Feature feature);

// How a target carries a feature: kExactly is said only of numbers that are carried unchanged.
enum class Carries { kExactly, kApproximately, kNot };
struct Carried {
  Feature feature = Feature::kShape;
  Carries how = Carries::kExactly;
  std::string note;  // in which form, or what becomes of it
};

// Where and with which comments files are written.
struct WriteContext {
  std::filesystem::path folder;
  std::string name;                 // of the material; files are NAME and an ending
  std::vector<std::string> header;  // lines of the comment at the top of text files
  std::string map_path;             // folder before the name of a normal map, as the renderer is to look for it
  bool old_mitsuba = false;         // for Mitsuba 3.0 to 3.7.0

  std::filesystem::path File(std::string_view ending) const { return folder / (name + std::string(ending)); }
};

struct WrittenFiles {
  std::vector<std::filesystem::path> files;
  // The target's f_r in the fit's channels, from the written file where it can be read back; null: not measured.
  BrdfFunction brdf;
  bool exact = false;              // the file evaluates the model itself
  std::vector<std::string> notes;  // for people: what to do beside loading the file
};

// One row of the table of targets. Members that are null are what a target does not do.
struct Target {
  const char* name = "";
  const char* description = "";
  // One line: how to load it. {name} is the name of the material and of its files, {id} the name as an identifier,
  // {glsl} what names in GLSL begin with.
  const char* load = "";
  bool rgb_only = false;       // holds R, G, B or one grey channel: other channels are converted for it
  bool by_wavelength = false;  // or a spectrum: channels without wavelengths (X Y Z) are converted for it
  // Why the target cannot hold this fit at all; "" where it can. Null: it holds every fit.
  std::string (*refusal)(const FittedBrdf& fit) = nullptr;
  std::vector<Carried> (*carries)(const FittedBrdf& fit) = nullptr;
  // The model nearest to the target's own among those that can be fitted; null: numbers are never refitted.
  Model (*own_model)(const FittedBrdf& fit) = nullptr;
  // The target's own model with the numbers of `fit` translated: f_r in the fit's channels. Null where `write` has it.
  BrdfFunction (*evaluate)(const FittedBrdf& fit) = nullptr;
  WrittenFiles (*write)(const FittedBrdf& fit, const WriteContext& context) = nullptr;
  // A table of squared ellipsoidal lobes in place of a model; null: the target cannot hold one.
  WrittenFiles (*write_sel)(const Material& material, const WriteContext& context) = nullptr;
  // Whether the bytes look like a file of this target, and the reader, which throws InputError with the place of what
  // is not understood: an input that the reader does not evaluate is an error or stands in the remarks.
  bool (*recognises)(std::string_view bytes) = nullptr;
  ImportedMaterial (*read)(const InputFile& file) = nullptr;
  bool is_text = false;  // a few numbers and names: files beyond 16 MiB are refused before they are read
};

// A function of R, G, B as one of the fit's channels: itself, or its first channel where the fit is grey.
BrdfFunction InChannelsOf(const FittedBrdf& fit, const BrdfFunction& rgb);

}  // namespace lobefit
