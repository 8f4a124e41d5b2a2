#include <map>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/file.h"
#include "lobefit/base/text.h"
#include "lobefit/export/targets/pbrt/write.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

struct Token {
  std::string text;
  std::size_t line = 1;
  bool quoted = false;
};

// Words, quoted strings and brackets; comments are dropped.
std::vector<Token> Tokens(std::string_view text) {
  std::vector<Token> tokens;
  LineReader lines(text);
  std::string_view line;
  while (lines.Next(&line)) {
    for (std::size_t i = 0; i < line.size();) {
      const char c = line[i];
      if (c == '#') break;
      if (c == ' ' || c == '\t' || c == '\r') {
        ++i;
      } else if (c == '"') {
        const std::size_t end = std::min(line.find('"', i + 1), line.size());
        tokens.push_back({std::string(line.substr(i + 1, end - i - 1)), lines.line_number(), true});
        i = end + 1;
      } else if (c == '[' || c == ']') {
        tokens.push_back({std::string(1, c), lines.line_number(), false});
        ++i;
      } else {
        const std::size_t end = std::min(line.find_first_of(" \t\r\"[]#", i), line.size());
        tokens.push_back({std::string(line.substr(i, end - i)), lines.line_number(), false});
        i = end;
      }
    }
  }
  return tokens;
}

struct Entry {
  std::map<std::string, std::vector<std::string>> parameters;
  std::size_t line = 0;
};

class PbrtReader {
 public:
  PbrtReader(std::string_view text, const std::filesystem::path& path)
      : path_(path), tokens_(Tokens(text)), rotation_(RotationOfComment(text)) {}

  Surface Read() {
    Parse();
    if (last_.empty()) throw InputError(path_.string() + ": holds no Material or MakeNamedMaterial");
    Surface surface;
    Add(last_, 1, 0, &surface);
    return surface;
  }

 private:
  [[noreturn]] void Fail(std::size_t line, const std::string& message) const {
    throw InputError(fmt::format("{}: line {}: {}", path_.string(), line, message));
  }

  void Parse() {
    for (at_ = 0; at_ < tokens_.size();) {
      const Token directive = tokens_[at_++];
      const bool named = directive.text == "MakeNamedMaterial", plain = directive.text == "Material";
      if (directive.quoted || (!named && !plain)) {
        if (directive.text == "NamedMaterial" && at_ < tokens_.size()) last_ = tokens_[at_].text;
        continue;
      }
      if (at_ >= tokens_.size() || !tokens_[at_].quoted) Fail(directive.line, "a quoted name is expected here");
      const std::string name = tokens_[at_++].text;
      Entry entry = {Parameters(), directive.line};
      if (plain) entry.parameters["type"] = {name};
      last_ = plain ? fmt::format("material in line {}", directive.line) : name;
      entries_[last_] = std::move(entry);
    }
  }

  std::map<std::string, std::vector<std::string>> Parameters() {
    std::map<std::string, std::vector<std::string>> parameters;
    while (at_ < tokens_.size() && tokens_[at_].quoted) {
      const Token declaration = tokens_[at_++];
      const std::vector<std::string_view> words = SplitBlanks(declaration.text);
      if (words.size() != 2) {
        Fail(declaration.line, fmt::format("'{}' is not a type and a name", Excerpt(declaration.text)));
      }
      std::vector<std::string>& values = parameters[std::string(words[1])];
      if (words[0] == "spectrum") Fail(declaration.line, "spectra are not understood; write rgb values");
      if (at_ < tokens_.size() && tokens_[at_].text == "[" && !tokens_[at_].quoted) {
        for (++at_; at_ < tokens_.size() && (tokens_[at_].quoted || tokens_[at_].text != "]"); ++at_) {
          values.push_back(tokens_[at_].text);
        }
        if (at_++ >= tokens_.size()) Fail(declaration.line, "this list has no end");
      } else if (at_ < tokens_.size()) {
        values.push_back(tokens_[at_++].text);
      }
    }
    return parameters;
  }

  double Real(const Entry& entry, const char* name, double otherwise) const {
    const auto found = entry.parameters.find(name);
    if (found == entry.parameters.end() || found->second.empty()) return otherwise;
    const std::optional<double> value = ParseDouble(found->second[0]);
    if (!value) Fail(entry.line, fmt::format("{} '{}' is not a number", name, Excerpt(found->second[0])));
    return *value;
  }

  std::optional<Color3> Color(const Entry& entry, const char* name) const {
    const auto found = entry.parameters.find(name);
    if (found == entry.parameters.end()) return std::nullopt;
    Color3 color = {};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::optional<double> value = found->second.size() == 3 ? ParseDouble(found->second[c]) : std::nullopt;
      if (!value) Fail(entry.line, fmt::format("{} is not three numbers", name));
      color[c] = *value;
    }
    return color;
  }

  void Add(const std::string& name, double weight, int depth, Surface* surface) const {
    const auto found = entries_.find(name);
    if (found == entries_.end() || depth > 8) {
      throw InputError(fmt::format("{}: the material '{}' is not defined in the file", path_.string(), Excerpt(name)));
    }
    const Entry& entry = found->second;
    const auto type = entry.parameters.find("type");
    const std::string kind = type == entry.parameters.end() || type->second.empty() ? "" : type->second[0];
    if (kind == "mix") {
      const auto materials = entry.parameters.find("materials");
      if (materials == entry.parameters.end() || materials->second.size() != 2) {
        Fail(entry.line, "a mix needs two materials");
      }
      const double amount = Real(entry, "amount", 0.5);
      Add(materials->second[0], weight * (1 - amount), depth + 1, surface);
      Add(materials->second[1], weight * amount, depth + 1, surface);
    } else if (kind == "diffuse") {
      const Color3 reflectance = Color(entry, "reflectance").value_or(Color3{0.5, 0.5, 0.5});
      for (std::size_t c = 0; c < 3; ++c) surface->diffuse[c] += weight * reflectance[c];
    } else if (kind == "conductor") {
      AddConductor(entry, weight, surface);
    } else {
      Fail(entry.line,
           fmt::format("the material type '{}' is not understood; conductor, diffuse and mix are", Excerpt(kind)));
    }
  }

  void AddConductor(const Entry& entry, double weight, Surface* surface) const {
    SurfaceLobe lobe;
    lobe.weight = weight;
    lobe.rotation = rotation_;
    const double roughness = Real(entry, "roughness", 0);
    const auto remap = entry.parameters.find("remaproughness");
    const bool remapped = remap == entry.parameters.end() || remap->second != std::vector<std::string>{"false"};
    const auto alpha = [&](const char* name) {
      const double value = Real(entry, name, roughness);
      return std::max(1e-4, remapped ? PbrtRemappedAlpha(value) : value);
    };
    const double along_u = alpha("uroughness"), along_v = alpha("vroughness");
    lobe.widths = {along_u, along_v};
    lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
    const std::optional<Color3> reflectance = Color(entry, "reflectance");
    if (reflectance) {
      for (std::size_t c = 0; c < 3; ++c) {
        const ConductorIndex index = ConductorOfReflectance((*reflectance)[c]);
        lobe.fresnel.eta[c] = index.eta;
        lobe.fresnel.k[c] = index.k;
      }
    } else if (const std::optional<Color3> eta = Color(entry, "eta"), k = Color(entry, "k"); eta && k) {
      lobe.fresnel.eta = *eta;
      lobe.fresnel.k = *k;
    } else {
      Fail(entry.line,
           "a conductor needs \"rgb reflectance\", or \"rgb eta\" and \"rgb k\"; named metals are not known");
    }
    if (const auto map = entry.parameters.find("normalmap"); map != entry.parameters.end() && !map->second.empty()) {
      const std::filesystem::path png = path_.parent_path() / map->second[0];
      lobe.normal = RotateZ(NormalOfPng(MappedFile(png).bytes(), 1, png), rotation_);
    }
    surface->lobes.push_back(lobe);
  }

  const std::filesystem::path& path_;
  std::vector<Token> tokens_;
  double rotation_;
  std::size_t at_ = 0;
  std::map<std::string, Entry> entries_;
  std::string last_;
};

}  // namespace

Surface ReadPbrt(std::string_view text, const std::filesystem::path& path) { return PbrtReader(text, path).Read(); }

}  // namespace lobefit
