#include "lobefit/io/alta/header.h"

#include <algorithm>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

constexpr std::size_t kMostOutputs = 4096;

// "#ALTA HEADER END" (code), "#ALTA END HEADER" (manual) and "#ALTA_END_HEADER" (files), and the like for the
// beginning.
bool IsMark(std::string_view line, const char* which) {
  const std::string mark = ToLower(Trim(line)), word = which;
  return mark == "alta header " + word || mark == "alta " + word + " header" || mark == "alta_header_" + word ||
         mark == "alta_" + word + "_header";
}

void ReadDim(const InputFile& file, const AltaHeader& header, AltaLayout* layout, std::size_t* inputs) {
  const AltaEntry& dim = RequireKey(file, header, "DIM", "3 1");
  const std::vector<std::string_view> words = SplitBlanks(dim.value);
  const std::optional<long long> x = words.size() == 2 ? ParseInteger(words[0]) : std::nullopt;
  const std::optional<long long> y = words.size() == 2 ? ParseInteger(words[1]) : std::nullopt;
  if (!x || !y || *x < 1 || *x > 6 || *y < 1 || *y > static_cast<long long>(kMostOutputs)) {
    FailAtLine(file, dim.line,
               "#DIM is '" + Excerpt(dim.value) + "'; allowed are two counts, 1 to 6 coordinates and 1 to " +
                   std::to_string(kMostOutputs) + " values, as in '#DIM 3 1'");
  }
  *inputs = static_cast<std::size_t>(*x);
  layout->outputs = static_cast<std::size_t>(*y);
}

void ReadInput(const InputFile& file, const AltaHeader& header, std::size_t inputs, AltaLayout* layout) {
  const AltaEntry& entry = RequireKey(file, header, "PARAM_IN", "RUSIN_TH_TD_PD");
  std::vector<std::string> names;
  for (const AltaInput& input : AltaInputs()) {
    if (input.name == entry.value) layout->input = &input;
    names.emplace_back(input.name);
  }
  if (layout->input == nullptr) {
    FailAtLine(file, entry.line,
               "#PARAM_IN is '" + Excerpt(entry.value) + "'" + DidYouMean(entry.value, names) +
                   "; directions are known for " + Join(names));
  }
  if (layout->input->dimension != inputs) {
    FailAtLine(file, entry.line,
               "#PARAM_IN " + std::string(layout->input->name) + " has " + std::to_string(layout->input->dimension) +
                   " coordinates, but #DIM states " + std::to_string(inputs));
  }
}

void ReadOutput(const InputFile& file, const AltaHeader& header, const ReadOptions& options, AltaLayout* layout) {
  const AltaEntry* entry = FindKey(header, "PARAM_OUT");
  const std::string stated = entry == nullptr ? "UNKNOWN_OUTPUT" : entry->value;
  const std::vector<std::string_view> words = SplitBlanks(stated);
  const std::string name(words.empty() ? "UNKNOWN_OUTPUT" : words[0]);
  const std::size_t line = entry == nullptr ? std::max<std::size_t>(header.end_line, 1) : entry->line;
  for (const std::string_view word : words) {
    if (word != name) {
      FailAtLine(file, line,
                 "#PARAM_OUT names different outputs, '" + Excerpt(name) + "' and '" + Excerpt(word) +
                     "'; one kind of value a file is allowed");
    }
  }
  layout->kind_from_option = options.value_kind.has_value();
  layout->kind_not_stated = entry == nullptr && !options.value_kind;
  if (name == "INV_STERADIAN_COSINE_FACTOR") {
    layout->kind = ValueKind::kBrdfCosO;
  } else if (name != "INV_STERADIAN" && name != "RGB_COLOR" && name != "XYZ_COLOR" && !options.value_kind &&
             !layout->kind_not_stated) {
    FailAtLine(file, line,
               "#PARAM_OUT is '" + Excerpt(name) +
                   "', which does not say what the values are; known are "
                   "INV_STERADIAN, INV_STERADIAN_COSINE_FACTOR, RGB_COLOR and XYZ_COLOR: state it with "
                   "--value-kind, one of " +
                   AllowedValueKinds());
  }
  layout->kind = options.value_kind.value_or(layout->kind);
  if ((name == "RGB_COLOR" || name == "XYZ_COLOR") && layout->outputs != 3) {
    FailAtLine(file, line, "#PARAM_OUT " + name + " has 3 values, but #DIM states " + std::to_string(layout->outputs));
  }
  if (layout->outputs == 1) {
    layout->channels.names = {"Y"};
  } else if (layout->outputs == 3) {
    layout->channels.names =
        name == "XYZ_COLOR" ? std::vector<std::string>{"X", "Y", "Z"} : std::vector<std::string>{"R", "G", "B"};
  } else {
    for (std::size_t c = 1; c <= layout->outputs; ++c) layout->channels.names.push_back("y" + std::to_string(c));
  }
}

void ReadIntervals(const InputFile& file, const AltaHeader& header, AltaLayout* layout) {
  layout->intervals.assign(layout->outputs, 0);
  const AltaEntry* entry = FindKey(header, "VS");
  if (entry == nullptr) return;
  const std::vector<std::string_view> words = SplitBlanks(entry->value);
  layout->one_interval_number = words.size() == 1;
  bool valid = !words.empty() && words.size() <= layout->outputs;
  for (std::size_t c = 0; valid && c < words.size(); ++c) {
    const std::optional<long long> columns = ParseInteger(words[c]);
    valid = columns && *columns >= 0 && *columns <= 2;
    if (valid) layout->intervals[c] = static_cast<int>(*columns);
  }
  if (!valid) {
    FailAtLine(file, entry->line,
               "#VS is '" + Excerpt(entry->value) + "'; allowed is 0, 1 or 2 for each of the " +
                   std::to_string(layout->outputs) + " values");
  }
}

}  // namespace

AltaHeader ReadAltaHeader(const InputFile& file) {
  AltaHeader header;
  LineReader lines(file.bytes);
  std::string_view line;
  while (header.end = lines.offset(), header.end_line = lines.line_number(), lines.Next(&line)) {
    if (Trim(line).empty()) continue;
    if (line[0] != '#') break;
    if (line.size() == 1) continue;
    if (line[1] == ' ' || line[1] == '\t') {
      const std::string_view comment = Trim(line.substr(1));
      header.sigma = header.sigma || comment == kAltaSigma;
      // The names of channels are this program's note.
      if (!comment.empty() && comment != kAltaSigma && !comment.starts_with("channels: "))
        header.comments.emplace_back(comment);
      continue;
    }
    line.remove_prefix(1);
    const std::vector<std::string_view> words = SplitBlanks(line);
    if (words.empty()) continue;
    if (IsMark(line, "begin")) continue;
    header.ended = IsMark(line, "end");
    header.stream = words[0] == "BEGIN_STREAM";
    if (header.ended || header.stream) {
      header.end = lines.offset();
      header.end_line = lines.line_number();
      constexpr std::string_view kBeginStream = "#BEGIN_STREAM\n";
      if (header.ended && file.bytes.substr(header.end, kBeginStream.size()) == kBeginStream) {
        header.stream = true;
        header.end += kBeginStream.size();
      }
      break;
    }
    const std::string key(words[0]);
    const auto [entry, is_new] =
        header.keys.emplace(key, AltaEntry{std::string(Trim(line.substr(key.size()))), lines.line_number()});
    if (!is_new) {
      FailAtLine(file, lines.line_number(),
                 "the key #" + Excerpt(key) + " stands in line " + std::to_string(entry->second.line) + " already");
    }
  }
  return header;
}

const AltaEntry* FindKey(const AltaHeader& header, const std::string& key) {
  const auto entry = header.keys.find(key);
  return entry == header.keys.end() ? nullptr : &entry->second;
}

const AltaEntry& RequireKey(const InputFile& file, const AltaHeader& header, const std::string& key,
                            const std::string& example) {
  const AltaEntry* entry = FindKey(header, key);
  if (entry == nullptr) {
    FailAtLine(file, std::max<std::size_t>(header.end_line, 1),
               "the header ends without #" + key + "; add it, as in '#" + key + " " + example + "'");
  }
  return *entry;
}

AltaLayout ReadAltaLayout(const InputFile& file, const AltaHeader& header, const ReadOptions& options) {
  AltaLayout layout;
  std::size_t inputs = 0;
  ReadDim(file, header, &layout, &inputs);
  ReadInput(file, header, inputs, &layout);
  ReadOutput(file, header, options, &layout);
  ReadIntervals(file, header, &layout);
  return layout;
}

}  // namespace lobefit
