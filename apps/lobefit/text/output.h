// Text for people on standard output, or on standard error where standard output carries data.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"

namespace lobefit {

// Names of channels, samples and files come from files: nothing in `text` but newlines and tabs moves the cursor.
inline void Print(const std::string& text, std::FILE* stream = stdout) {
  fmt::print(stream, "{}", PrintableLines(text));
}

// Where a verb's summary goes that writes `output`.
inline std::FILE* SummaryStream(const std::filesystem::path& output) {
  return IsStandardOutput(output) ? stderr : stdout;
}

// NAME of the results: as given, or the one that they have of their own. Throws UsageError for a path.
inline std::string ResultName(const std::string& given, const std::string& own) {
  const std::string& name = given.empty() ? own : given;
  if (name.find('/') != std::string::npos)
    throw UsageError(fmt::format("--name '{}' is a path; the folder is given by --out", Excerpt(name)));
  return name;
}

// A picture that a verb is to write, before its work. Throws UsageError for a name that says another format, and as
// CheckOutput.
inline void CheckPicture(const std::filesystem::path& picture, const std::vector<std::filesystem::path>& inputs) {
  if (picture.extension() != ".png" && !IsStream(picture)) {
    throw UsageError(fmt::format("{}: the picture is a PNG; end its name in .png", PrintableName(picture)));
  }
  CheckOutput(picture, inputs);
}

}  // namespace lobefit
