#include "lobefit/export/targets/mitsuba/write.h"

#include <algorithm>

#include <fmt/format.h>

#include "lobefit/base/files/file.h"
#include "lobefit/export/targets/features.h"
#include "lobefit/export/targets/mitsuba/components.h"
#include "lobefit/export/targets/mitsuba/read.h"
#include "lobefit/export/targets/spectra.h"
#include "lobefit/export/targets/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/renderer/normal_map.h"

namespace lobefit {
namespace {

std::vector<Carried> CarriesMitsuba(const FittedBrdf& fit) {
  std::vector<Carried> rows = CarriesConductors(fit, Masking::kSmithSeparable, "separable Smith");
  if (!fit.IsRgbOrGrey()) {
    Mark(&rows, Feature::kChannels, Carries::kApproximately,
         "spectra, linear between the wavelengths and constant beyond them; rgb variants make R G B of eta and of k");
  }
  return rows;
}

Model SeparableModel(const FittedBrdf& fit) { return OwnModel(fit, Masking::kSmithSeparable, kAnyNumber); }
BrdfFunction EvaluateMitsuba(const FittedBrdf& fit) { return InChannelsOf(fit, SurfaceBrdf(MitsubaSurface(fit))); }

// Spectral variants fit a spectrum of reflectance to an rgb value, which ends at 1.
bool IsClampedInSpectralVariants(const FittedBrdf& fit, const Surface& surface) {
  return fit.IsRgbOrGrey() && std::any_of(surface.lobes.begin(), surface.lobes.end(), [](const SurfaceLobe& lobe) {
           const auto above_one = [](double value) { return value > 1; };
           return std::any_of(lobe.fresnel.eta.begin(), lobe.fresnel.eta.end(), above_one) ||
                  std::any_of(lobe.fresnel.k.begin(), lobe.fresnel.k.end(), above_one);
         });
}

// Of the XML; the Python file names its map by its own folder.
std::string MapNote(const std::vector<std::string>& maps) {
  return MapComment(maps, "the main scene file, also where this file is included from another folder");
}

// What the user has to know beside loading the file.
std::vector<std::string> Notes(const FittedBrdf& fit, const Surface& surface, const std::vector<std::string>& maps,
                               bool old_mitsuba) {
  std::vector<std::string> notes;
  if (!maps.empty()) {
    notes.emplace_back(
        old_mitsuba ? "The XML is for Mitsuba 3.0 to 3.7.0: from 3.7.1 on it is darker at grazing angles; export it "
                      "without --mitsuba-version there. The Python file asks for the version itself."
                    : "The XML needs Mitsuba 3.7.1 or newer; --mitsuba-version 3.7.0 of the export writes it for "
                      "3.0 to 3.7.0, which refuse use_shadowing_function. The Python file asks for the version "
                      "itself.");
    notes.push_back(MapNote(maps));
  }
  if (IsClampedInSpectralVariants(fit, surface)) {
    notes.emplace_back(
        "For rgb variants: spectral ones clamp eta and k to 1, so that this material is too dark or of a wrong colour "
        "there; use the _spec.bsdf of the target rgl there.");
  }
  notes.emplace_back("One-sided, as every conductor is: <bsdf type=\"twosided\"> around it lights back faces.");
  return notes;
}

std::string PythonText(const std::vector<std::string>& header, const std::string& material, bool spectral) {
  const std::string variant = spectral ? "a spectral" : "an rgb";
  return CommentLines(header, "#") + "import os\n\n\ndef material(mi, np):\n    \"\"\"The BSDF for mi.load_dict, of " +
         variant +
         " variant; mi and np are the modules mitsuba and numpy.\"\"\"\n"
         "    folder = os.path.dirname(os.path.abspath(__file__))\n"
         "    version = tuple(int(part) for part in mi.__version__.split('.')[:3])\n"
         "    shadowing = {'use_shadowing_function': False} if version >= (3, 7, 1) else {}\n\n"
         "    def constant(*rgb):\n        pixel = mi.Bitmap(np.array([[rgb]], dtype=np.float32))\n"
         "        return {'type': 'bitmap', 'bitmap': pixel, 'raw': True}\n\n    return (\n" +
         Indented(material, "        ") + ")\n";
}

WrittenFiles WriteMitsuba(const FittedBrdf& fit, const WriteContext& context) {
  const Surface surface = MitsubaSurface(fit);
  const std::vector<double> wavelengths = fit.IsRgbOrGrey() ? std::vector<double>() : fit.material().wavelengths_nm;
  const double rotation = CommonRotation(fit);
  WrittenFiles written;
  std::vector<MitsubaComponent> components;
  std::vector<std::string> maps;
  for (std::size_t l = 0; l < surface.lobes.size(); ++l) {
    components.push_back(MitsubaLobe(surface.lobes[l], wavelengths));
    if (surface.lobes[l].normal.z < 1) {
      const std::filesystem::path map = context.File(fmt::format("_normal{}.png", l + 1));
      WriteFileAtomically(map, NormalMapPng(RotateZ(surface.lobes[l].normal, -rotation)));
      written.files.push_back(map);
      maps.push_back(context.map_path + map.filename().string());
      Tilt(maps.back(), map.filename().string(), !context.old_mitsuba, &components.back());
    }
  }
  if (fit.HasDiffuse() || components.empty()) {
    const double share = SharesOf(fit).diffuse;
    Spectrum reflectance = surface.diffuse;
    for (double& value : reflectance) value /= share;
    components.push_back(MitsubaDiffuse(reflectance, share, wavelengths));
  }
  const MitsubaComponent whole = Blend(std::move(components));

  written.notes = Notes(fit, surface, maps, context.old_mitsuba);
  std::vector<std::string> header = context.header;
  header.insert(header.end(), written.notes.begin(), written.notes.end());
  for (const std::string& line : RotationComment(rotation)) header.push_back(line);
  std::string xml = whole.xml;
  xml.insert(5, fmt::format(" id=\"{}\"", Identifier(context.name)));
  const std::filesystem::path path = context.File(".mitsuba.xml"), python = context.File(".mitsuba.py");
  WriteFileAtomically(path, XmlComment(header) + "<scene version=\"3.0.0\">\n" + Indented(xml, "  ") + "\n</scene>\n");
  if (!maps.empty()) std::erase(header, MapNote(maps));
  WriteFileAtomically(python, PythonText(header, whole.python, !wavelengths.empty()));
  written.files.insert(written.files.begin(), {path, python});
  const FileBytes bytes(path);
  const ImportedMaterial back = ReadMitsuba({path, bytes.bytes()});
  written.brdf = wavelengths.empty() ? InChannelsOf(fit, back.brdf)
                                     : AtWavelengths(back.brdf, back.channels.wavelengths_nm, wavelengths);
  if (rotation != 0) {
    written.notes.push_back(fmt::format("turn the mesh's texture coordinates by {:.4g} degrees (the file says how)",
                                        RadiansToDegrees(rotation)));
  }
  return written;
}

}  // namespace

Surface MitsubaSurface(const FittedBrdf& fit) {
  Surface surface;
  surface.masking = SurfaceMasking::kSeparable;
  const Shares shares = SharesOf(fit);
  for (std::size_t l = 0; l < fit.lobes().size(); ++l) {
    if (shares.lobes[l] == 0) continue;
    SurfaceLobe lobe = LobeOf(fit, l, shares.lobes[l]);
    lobe.rotation = CommonRotation(fit);
    lobe.fresnel = ConductorFresnelOf(fit, l, shares.lobes[l]);
    surface.lobes.push_back(lobe);
  }
  surface.diffuse = DiffuseOf(fit);
  return surface;
}

Target MitsubaTarget() {
  return {.name = "mitsuba",
          .description = "Mitsuba 3: roughconductor and diffuse, as XML and Python dict",
          .load =
              "<include filename=\"{name}.mitsuba.xml\"/>, then <ref id=\"{id}\"/>, for back faces within <bsdf "
              "type=\"twosided\">",
          .by_wavelength = true,
          .refusal = RefuseForeignLobes,
          .carries = CarriesMitsuba,
          .own_model = SeparableModel,
          .evaluate = EvaluateMitsuba,
          .write = WriteMitsuba,
          .recognises = IsMitsuba,
          .read = ReadMitsuba,
          .is_text = true};
}

}  // namespace lobefit
