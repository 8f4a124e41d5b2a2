#include "lobefit/export/targets/pbrt/read.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/export/targets/pbrt/tokens.h"
#include "lobefit/export/targets/spectra.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"
#include "lobefit/renderer/surface.h"

namespace lobefit {
namespace {

struct Value {
  std::string type;
  std::vector<std::string> words;
  std::size_t line = 0;
};

struct Entry {
  std::map<std::string, Value> parameters;
  std::size_t line = 0;
};

// What each type of material takes, with the types of its values.
using Known = std::map<std::string, std::vector<std::string>>;
const std::map<std::string, Known>& KnownParameters() {
  static const std::vector<std::string> color = {"rgb", "spectrum"};
  static const std::map<std::string, Known> known = {
      {"conductor",
       {{"type", {"string"}},
        {"reflectance", color},
        {"eta", color},
        {"k", color},
        {"roughness", {"float"}},
        {"uroughness", {"float"}},
        {"vroughness", {"float"}},
        {"remaproughness", {"bool"}},
        {"normalmap", {"string"}}}},
      {"diffuse", {{"type", {"string"}}, {"reflectance", color}, {"normalmap", {"string"}}}},
      {"mix", {{"type", {"string"}}, {"materials", {"string"}}, {"amount", {"float"}}}}};
  return known;
}

class PbrtReader {
 public:
  explicit PbrtReader(const InputFile& file)
      : path_(file.path), tokens_(PbrtTokens(file.bytes)), rotation_(RotationOfComment(file.bytes)) {}

  ImportedMaterial Read() {
    Parse();
    if (last_.empty()) throw InputError(path_.string() + ": holds no Material or MakeNamedMaterial");
    FindChannels();
    Surface surface;
    surface.diffuse.assign(channel_count(), 0.0);
    Add(last_, 1, 0, &surface);
    ImportedMaterial result = {"pbrt", channels_, SurfaceBrdf(surface), remarks_};
    if (rotation_ != 0)
      result.remarks.emplace_back("the texture coordinates of the mesh are turned as the file's comment says");
    for (const auto& [name, entry] : entries_) {
      const auto reflectance = entry.parameters.find("reflectance");
      if (reflectance != entry.parameters.end() && reflectance->second.type == "rgb" &&
          std::any_of(reflectance->second.words.begin(), reflectance->second.words.end(),
                      [](const std::string& word) { return ParseDouble(word).value_or(0) > 1; })) {
        result.remarks.push_back(
            fmt::format("the reflectance of line {} is above 1: more leaves than arrives", reflectance->second.line));
      }
      if (used_.count(name) == 0) {
        result.remarks.push_back(fmt::format("the material '{}' of line {} is left out: the last one, '{}', is taken",
                                             Excerpt(name), entry.line, Excerpt(last_)));
      }
    }
    return result;
  }

 private:
  [[noreturn]] void Fail(std::size_t line, const std::string& message) const {
    throw InputError(fmt::format("{}: line {}: {}", path_.string(), line, message));
  }

  std::size_t channel_count() const { return channels_.names.size(); }

  void Parse() {
    for (at_ = 0; at_ < tokens_.size();) {
      const PbrtToken directive = tokens_[at_++];
      const bool named = directive.text == "MakeNamedMaterial", plain = directive.text == "Material";
      if (directive.quoted || (!named && !plain)) {
        if (!directive.quoted && at_ < tokens_.size()) TakeOther(directive, tokens_[at_].text);
        continue;
      }
      if (at_ >= tokens_.size() || !tokens_[at_].quoted) Fail(directive.line, "a quoted name is expected here");
      const std::string name = tokens_[at_++].text;
      Entry entry = {Parameters(), directive.line};
      if (plain) entry.parameters["type"] = {"string", {name}, directive.line};
      last_ = plain ? fmt::format("material in line {}", directive.line) : name;
      if (!entries_.emplace(last_, std::move(entry)).second)
        Fail(directive.line, fmt::format("the material '{}' is defined twice", Excerpt(name)));
    }
  }

  // Directives that concern the materials after them.
  void TakeOther(const PbrtToken& directive, const std::string& word) {
    if (directive.text == "NamedMaterial") {
      last_ = word;
    } else if (directive.text == "ColorSpace" && word != "srgb") {
      Fail(directive.line, fmt::format("the colour space is '{}'; only srgb is understood", Excerpt(word)));
    } else if (directive.text == "Attribute" && word == "material") {
      Fail(directive.line,
           "an Attribute for materials changes those after it and is not understood; write its parameters into them");
    } else if (directive.text == "Include" || directive.text == "Import") {
      remarks_.push_back(fmt::format("the file '{}' of line {} was not looked into", Excerpt(word), directive.line));
    }
  }

  std::map<std::string, Value> Parameters() {
    std::map<std::string, Value> parameters;
    while (at_ < tokens_.size() && tokens_[at_].quoted) {
      const PbrtToken declaration = tokens_[at_++];
      const std::vector<std::string_view> words = SplitBlanks(declaration.text);
      if (words.size() != 2) {
        Fail(declaration.line, fmt::format("'{}' is not a type and a name", Excerpt(declaration.text)));
      }
      Value value = {std::string(words[0]), {}, declaration.line};
      if (at_ < tokens_.size() && tokens_[at_].text == "[" && !tokens_[at_].quoted) {
        for (++at_; at_ < tokens_.size() && (tokens_[at_].quoted || tokens_[at_].text != "]"); ++at_) {
          value.words.push_back(tokens_[at_].text);
        }
        if (at_++ >= tokens_.size()) Fail(declaration.line, "this list has no end");
      } else if (at_ < tokens_.size()) {
        value.words.push_back(tokens_[at_++].text);
      }
      if (value.words.empty()) Fail(declaration.line, fmt::format("'{}' has no value", Excerpt(declaration.text)));
      if (!parameters.emplace(std::string(words[1]), std::move(value)).second) {
        Fail(declaration.line, fmt::format("'{}' is given twice", Excerpt(words[1])));
      }
    }
    return parameters;
  }

  std::string TypeOf(const Entry& entry) const {
    const auto type = entry.parameters.find("type");
    return type == entry.parameters.end() ? "" : type->second.words[0];
  }

  // pbrt ends with an error where a parameter is not used, so that a misspelt one does not go unseen.
  void CheckParameters(const Entry& entry, const std::string& kind) const {
    const Known& known = KnownParameters().at(kind);
    std::vector<std::string> names;
    for (const auto& [name, types] : known) names.push_back(name);
    for (const auto& [name, value] : entry.parameters) {
      const auto found = known.find(name);
      if (found == known.end()) {
        Fail(value.line, fmt::format("the parameter '{}' of {} is not understood{}; allowed are {}", Excerpt(name),
                                     kind, DidYouMean(name, names), Join(names)));
      }
      if (std::find(found->second.begin(), found->second.end(), value.type) == found->second.end()) {
        Fail(value.line, fmt::format("'{}' is of the type '{}'; {} is understood, a constant value", Excerpt(name),
                                     Excerpt(value.type), Join(found->second, " or ")));
      }
      const bool single = value.type != "rgb" && value.type != "spectrum" && name != "materials";
      if (single && value.words.size() != 1) {
        Fail(value.line, fmt::format("'{}' has {} values; one is allowed", Excerpt(name), value.words.size()));
      }
    }
  }

  double Number(const Value& value, const std::string& word, const char* name) const {
    const std::optional<double> number = ParseDouble(word);
    if (!number) Fail(value.line, fmt::format("{} '{}' is not a number", name, Excerpt(word)));
    return *number;
  }

  double Real(const Entry& entry, const char* name, double otherwise) const {
    const auto found = entry.parameters.find(name);
    return found == entry.parameters.end() ? otherwise : Number(found->second, found->second.words[0], name);
  }

  SpectrumNodes NodesOf(const Value& value, const char* name) const {
    if (value.words.size() < 2 || value.words.size() % 2 != 0) {
      Fail(value.line, fmt::format("spectra by name are not known: '{}' needs pairs of a wavelength in nm and a value",
                                   Excerpt(name)));
    }
    SpectrumNodes nodes;
    for (std::size_t k = 0; k < value.words.size(); k += 2) {
      nodes.wavelengths_nm.push_back(Number(value, value.words[k], name));
      nodes.values.push_back(Number(value, value.words[k + 1], name));
      if (k > 0 && nodes.wavelengths_nm[k / 2] <= nodes.wavelengths_nm[k / 2 - 1]) {
        Fail(value.line, fmt::format("the wavelengths of '{}' do not increase", Excerpt(name)));
      }
    }
    return nodes;
  }

  // R, G, B, or the wavelengths that all spectra of the file share.
  void FindChannels() {
    std::vector<SpectrumNodes> spectra;
    for (const auto& [material, entry] : entries_) {
      for (const auto& [name, value] : entry.parameters) {
        if (value.type != "spectrum") continue;
        spectra.push_back(NodesOf(value, name.c_str()));
        if (spectra.back().wavelengths_nm != spectra[0].wavelengths_nm) {
          Fail(value.line, fmt::format("'{}' has other wavelengths than the spectra before it; one set is understood",
                                       Excerpt(name)));
        }
      }
    }
    channels_ = spectra.empty() ? Channels{{"R", "G", "B"}, {}} : WavelengthChannels(WavelengthsOf(spectra));
  }

  std::optional<Spectrum> Color(const Entry& entry, const char* name) const {
    const auto found = entry.parameters.find(name);
    if (found == entry.parameters.end()) return std::nullopt;
    const Value& value = found->second;
    Spectrum color;
    if (value.type == "spectrum") {
      const SpectrumNodes nodes = NodesOf(value, name);
      for (const double nm : channels_.wavelengths_nm) color.push_back(ValueAt(nodes, nm));
      return color;
    }
    if (!channels_.wavelengths_nm.empty()) {
      Fail(value.line, fmt::format("'{}' is rgb among spectra; all of one kind are understood", Excerpt(name)));
    }
    if (value.words.size() != 3) Fail(value.line, fmt::format("{} is not three numbers", name));
    for (const std::string& word : value.words) color.push_back(Number(value, word, name));
    for (const double part : color) {
      if (!(part >= 0)) Fail(value.line, fmt::format("{} holds {}; 0 and more is allowed", name, part));
    }
    return color;
  }

  void Add(const std::string& name, double weight, int depth, Surface* surface) {
    const auto found = entries_.find(name);
    constexpr int kMostDepth = 8;
    if (depth > kMostDepth) {
      throw InputError(fmt::format("{}: mixtures hold mixtures more than {} deep", path_.string(), kMostDepth));
    }
    if (found == entries_.end()) {
      throw InputError(fmt::format("{}: the material '{}' is not defined in the file", path_.string(), Excerpt(name)));
    }
    used_.insert(name);
    const Entry& entry = found->second;
    const std::string kind = TypeOf(entry);
    if (KnownParameters().count(kind) == 0) {
      Fail(entry.line,
           fmt::format("the material type '{}' is not understood; conductor, diffuse and mix are", Excerpt(kind)));
    }
    CheckParameters(entry, kind);
    if (kind == "mix") {
      const auto materials = entry.parameters.find("materials");
      if (materials == entry.parameters.end() || materials->second.words.size() != 2) {
        Fail(entry.line, "a mix needs two materials");
      }
      const double amount = Real(entry, "amount", 0.5);
      if (!(amount >= 0 && amount <= 1)) Fail(entry.line, fmt::format("the amount is {}; 0 to 1 is allowed", amount));
      Add(materials->second.words[0], weight * (1 - amount), depth + 1, surface);
      Add(materials->second.words[1], weight * amount, depth + 1, surface);
    } else if (kind == "diffuse") {
      const Spectrum reflectance = Color(entry, "reflectance").value_or(Spectrum(channel_count(), 0.5));
      for (std::size_t c = 0; c < reflectance.size(); ++c) surface->diffuse[c] += weight * reflectance[c];
      if (entry.parameters.count("normalmap") > 0) surface->diffuse_normal = NormalOf(entry);
    } else {
      AddConductor(entry, weight, surface);
    }
  }

  void AddConductor(const Entry& entry, double weight, Surface* surface) const {
    SurfaceLobe lobe;
    lobe.weight = weight;
    lobe.rotation = rotation_;
    lobe.fresnel.kind = SurfaceFresnel::Kind::kConductor;
    const std::optional<Spectrum> reflectance = Color(entry, "reflectance"), eta = Color(entry, "eta"),
                                  k = Color(entry, "k");
    if (reflectance && (eta || k)) Fail(entry.line, "a conductor takes reflectance or eta and k, not both");
    if (reflectance) {
      lobe.fresnel.eta.assign(reflectance->size(), 1.0);
      lobe.fresnel.k.clear();
      for (const double value : *reflectance) lobe.fresnel.k.push_back(ConductorOfReflectance(value).k);
    } else if (eta && k) {
      lobe.fresnel.eta = *eta;
      lobe.fresnel.k = *k;
    } else {
      Fail(entry.line,
           "a conductor needs \"rgb reflectance\", or \"rgb eta\" and \"rgb k\", or spectra; named metals are not "
           "known");
    }
    lobe.widths = WidthsOf(entry);
    if (entry.parameters.count("normalmap") > 0) lobe.normal = NormalOf(entry);
    surface->lobes.push_back(lobe);
  }

  Widths WidthsOf(const Entry& entry) const {
    const double roughness = Real(entry, "roughness", 0);
    bool remapped = true;
    if (const auto remap = entry.parameters.find("remaproughness"); remap != entry.parameters.end()) {
      const std::string& word = remap->second.words[0];
      if (word != "true" && word != "false") Fail(remap->second.line, "remaproughness is neither true nor false");
      remapped = word == "true";
    }
    const auto alpha = [&](const char* name) {
      const double value = Real(entry, name, roughness);
      if (!(value >= 0)) Fail(entry.line, fmt::format("{} is {}; 0 and more is allowed", name, value));
      return std::max(1e-4, remapped ? PbrtRemappedAlpha(value) : value);
    };
    const Widths widths = {alpha("uroughness"), alpha("vroughness")};
    if (std::max(widths.alpha_1, widths.alpha_2) < kPbrtMirror) {
      Fail(entry.line,
           "both widths are below 0.001 (the default is 0), which pbrt makes a perfect mirror: it has no f_r");
    }
    return widths;
  }

  // pbrt looks beside the main scene; here that is the file's folder.
  Vec3 NormalOf(const Entry& entry) const {
    const std::filesystem::path png = FindMap(path_, entry.parameters.at("normalmap").words[0]);
    return RotateZ(NormalOfPng(FileBytes(png).bytes(), 1, png), rotation_);
  }

  const std::filesystem::path& path_;
  std::vector<PbrtToken> tokens_;
  double rotation_;
  std::size_t at_ = 0;
  std::map<std::string, Entry> entries_;
  std::set<std::string> used_;
  std::vector<std::string> remarks_;
  std::string last_;
  Channels channels_;
};

}  // namespace

bool IsPbrt(std::string_view bytes) { return bytes.find("Material \"") != std::string_view::npos; }

ImportedMaterial ReadPbrt(const InputFile& file) { return PbrtReader(file).Read(); }

}  // namespace lobefit
