// Inputs of renderers' files: what is not understood is an error that names it, or stands in the remarks; and what is
// understood counts.
#include <cstdint>
#include <cstring>
#include <filesystem>

#include "tests/support/temporary_file.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/export/import.h"
#include "lobefit/math/directions.h"

namespace lobefit {
namespace {

using testing::HasSubstr;

std::string ErrorOf(const std::string& text) {
  const TemporaryFile file(text);
  try {
    ImportMaterial(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

ImportedMaterial Import(const std::string& text) {
  const TemporaryFile file(text);
  return ImportMaterial(file.path());
}

std::vector<double> ValuesOf(const ImportedMaterial& material) {
  std::vector<double> values(material.channels.size());
  material.brdf(FromSpherical(0.3, 0.2), FromSpherical(0.4, 2.9), values.data());
  return values;
}

std::string OpenPbr(const std::string& inputs) {
  return "<materialx version=\"1.39\"><open_pbr_surface name=\"s\" type=\"surfaceshader\">"
         "<input name=\"base_metalness\" type=\"float\" value=\"1\"/>" +
         inputs +
         "</open_pbr_surface><surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" "
         "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial></materialx>";
}
std::string Input(const char* name, const char* type, const char* value) {
  return std::string("<input name=\"") + name + "\" type=\"" + type + "\" value=\"" + value + "\"/>";
}

TEST(OpenPbrInputs, CountOrAreErrors) {
  const double plain = ValuesOf(Import(OpenPbr("")))[0];
  EXPECT_NEAR(ValuesOf(Import(OpenPbr(Input("base_weight", "float", "0.5"))))[0] / plain, 0.5, 0.02);
  // Of a metal it is the reflectance at 82 degrees: little changes near the normal, much at grazing.
  const Vec3 at_82 = FromSpherical(DegreesToRadians(82), 0), across = FromSpherical(DegreesToRadians(82), kPi);
  double tinted[3], white[3];
  Import(OpenPbr(Input("specular_color", "color3", "0.2, 0.2, 0.2"))).brdf(at_82, across, tinted);
  Import(OpenPbr("")).brdf(at_82, across, white);
  EXPECT_NEAR(tinted[0] / white[0], 0.2, 0.03);
  // Of no effect, since the layer has no weight.
  EXPECT_EQ(ValuesOf(Import(OpenPbr(Input("coat_roughness", "float", "0.4"))))[0], plain);
  // With one it makes the lobe below rougher, and darkens.
  const std::string coat = Input("coat_weight", "float", "1");
  const double coated = ValuesOf(Import(OpenPbr(coat + Input("coat_darkening", "float", "0"))))[0];
  EXPECT_NE(coated, plain);
  EXPECT_LT(ValuesOf(Import(OpenPbr(coat)))[0], coated);
  EXPECT_NEAR(ValuesOf(Import(OpenPbr(coat + Input("coat_color", "color3", "0.5, 0.5, 0.5"))))[0] /
                  ValuesOf(Import(OpenPbr(coat)))[0],
              0.5, 0.3);
  EXPECT_THAT(ErrorOf(OpenPbr(Input("coat_weight", "float", "2"))), HasSubstr("its coat has the weight 2"));
  EXPECT_THAT(ErrorOf(OpenPbr(coat + Input("base_color", "color3", "1, 2, 1"))), HasSubstr("its base_color is 2"));
  for (const auto& [name, value] : std::vector<std::pair<const char*, const char*>>{{"specular_weight", "0.3"},
                                                                                    {"fuzz_weight", "1"},
                                                                                    {"thin_film_weight", "0.5"},
                                                                                    {"geometry_opacity", "0.5"}}) {
    EXPECT_THAT(ErrorOf(OpenPbr(Input(name, "float", value))), HasSubstr(std::string("the input '") + name)) << name;
  }
  EXPECT_THAT(ErrorOf(OpenPbr(Input("specular_roughnes", "float", "0.4"))),
              HasSubstr("did you mean 'specular_roughness'"));
}

std::string Conductor(const std::string& inputs, const std::string& more = "") {
  return "<materialx version=\"1.39\"><conductor_bsdf name=\"b\" type=\"BSDF\">" + inputs +
         "</conductor_bsdf><surface name=\"s\" type=\"surfaceshader\"><input name=\"bsdf\" type=\"BSDF\" "
         "nodename=\"b\"/></surface><surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" "
         "type=\"surfaceshader\" nodename=\"s\"/></surfacematerial>" +
         more + "</materialx>";
}

// A layer over a diffuse part; `top` is the node of that name.
std::string Layered(const std::string& top) {
  return "<materialx version=\"1.39\">" + top +
         "<oren_nayar_diffuse_bsdf name=\"d\" type=\"BSDF\"/><layer name=\"l\" type=\"BSDF\"><input name=\"top\" "
         "type=\"BSDF\" nodename=\"top\"/><input name=\"base\" type=\"BSDF\" nodename=\"d\"/></layer><surface "
         "name=\"s\" type=\"surfaceshader\"><input name=\"bsdf\" type=\"BSDF\" nodename=\"l\"/></surface>"
         "<surfacematerial name=\"m\" type=\"material\"><input name=\"surfaceshader\" type=\"surfaceshader\" "
         "nodename=\"s\"/></surfacematerial></materialx>";
}
std::string Dielectric(const std::string& inputs) {
  return "<dielectric_bsdf name=\"top\" type=\"BSDF\">" + inputs + "</dielectric_bsdf>";
}

TEST(MaterialXLayers, AreACoatOfADielectricOrErrors) {
  EXPECT_EQ(ErrorOf(Layered(Dielectric(Input("ior", "float", "1.6")))), "no error");
  EXPECT_THAT(ErrorOf(Layered(Dielectric(Input("ior", "float", "0.7")))), HasSubstr("its ior is 0.7"));
  EXPECT_THAT(ErrorOf(Layered(Dielectric(Input("scatter_mode", "string", "RT")))), HasSubstr("'scatter_mode'"));
  EXPECT_THAT(ErrorOf(Layered(Dielectric(Input("tint", "color3", "0.5, 0.5, 0.5")))), HasSubstr("'tint'"));
  EXPECT_THAT(ErrorOf(Layered("<conductor_bsdf name=\"top\" type=\"BSDF\"/>")), HasSubstr("as its top only"));
  EXPECT_THAT(ErrorOf(Layered("")), HasSubstr("names no node"));
}

TEST(MaterialXInputs, CountOrAreErrors) {
  EXPECT_EQ(ErrorOf(Conductor(Input("thinfilm_thickness", "float", "0"))), "no error");
  EXPECT_THAT(ErrorOf(Conductor(Input("thinfilm_thickness", "float", "500"))), HasSubstr("'thinfilm_thickness'"));
  EXPECT_THAT(ErrorOf(Conductor(Input("retroreflective", "boolean", "true"))), HasSubstr("'retroreflective'"));
  EXPECT_THAT(ErrorOf(Conductor(Input("distribution", "string", "beckmann"))), HasSubstr("only ggx"));
  EXPECT_THAT(ErrorOf(Conductor("<input name=\"weight\" type=\"float\" nodename=\"x\"/>")), HasSubstr("'weight'"));
  const std::string second = "<surfacematerial name=\"other\" type=\"material\"/>";
  EXPECT_THAT(Import(Conductor("", second)).remarks, testing::Contains(HasSubstr("'other'")));
  // A file of 2 KB whose tree has 2^20 leaves.
  std::string bomb = "<materialx version=\"1.39\"><normal name=\"v0\" type=\"vector3\"/>";
  for (int k = 1; k <= 15; ++k) {
    const std::string n = std::to_string(k - 1);
    bomb += "<add name=\"v" + std::to_string(k) + "\" type=\"vector3\"><input name=\"in1\" nodename=\"v" + n +
            "\"/><input name=\"in2\" nodename=\"v" + n + "\"/></add>";
  }
  EXPECT_THAT(ErrorOf(bomb + Conductor("<input name=\"normal\" type=\"vector3\" nodename=\"v15\"/>").substr(26)),
              HasSubstr("too large"));
}

TEST(MaterialXInputs, NormalsPointOutOfTheSurface) {
  const std::string tangent = "<tangent name=\"t\" type=\"vector3\"/>";
  const std::string flat = Conductor("<input name=\"normal\" type=\"vector3\" nodename=\"t\"/>", tangent);
  EXPECT_THAT(ErrorOf(flat), HasSubstr("its normal does not point out of the surface"));
  const std::string coat = Input("coat_weight", "float", "1");
  std::string coated = OpenPbr(coat + "<input name=\"geometry_coat_normal\" type=\"vector3\" nodename=\"t\"/>");
  coated.insert(coated.rfind("</materialx>"), tangent);
  EXPECT_THAT(ErrorOf(coated), HasSubstr("its geometry_coat_normal does not point out of the surface"));
  EXPECT_THAT(ErrorOf(OpenPbr(coat + Input("coat_darkening", "float", "-3"))), HasSubstr("the darkening -3"));
}

// A colour of another space, and a value that is not the one used.
TEST(MaterialXInputs, ColoursAreLinearAndConstant) {
  const std::string linear = "<input name=\"ior\" type=\"color3\" value=\"0.2, 0.2, 0.2\" colorspace=\"lin_rec709\"/>";
  EXPECT_EQ(ErrorOf(Conductor(linear)), "no error");
  const std::string other = "<input name=\"ior\" type=\"color3\" value=\"0.2, 0.2, 0.2\" colorspace=\"srgb_texture\"/>";
  EXPECT_THAT(ErrorOf(Conductor(other)), HasSubstr("'ior' is a colour in the space 'srgb_texture'"));
  std::string document = Conductor(Input("ior", "color3", "0.2, 0.2, 0.2"));
  document.replace(0, 11, "<materialx colorspace=\"srgb_texture\" ");
  EXPECT_THAT(ErrorOf(document), HasSubstr("'ior' is a colour in the space 'srgb_texture'"));
  for (const char* more :
       {"nodename=\"tex\"", "nodegraph=\"g\" output=\"o\"", "interfacename=\"i\"", "unit=\"inch\""}) {
    EXPECT_THAT(ErrorOf(Conductor("<input name=\"weight\" type=\"float\" value=\"1\" " + std::string(more) + "/>")),
                HasSubstr("'weight' has a value and the attribute"))
        << more;
  }
  EXPECT_THAT(ErrorOf(Conductor(Input("weight", "float", "1") + Input("weight", "float", "0.5"))),
              HasSubstr("given twice"));
  EXPECT_THAT(ErrorOf(Conductor("<parameter name=\"weight\" type=\"float\" value=\"0.5\"/>")),
              HasSubstr("<parameter> within <conductor_bsdf>"));
  std::string defined = Conductor("");
  defined.replace(defined.find("type=\"BSDF\""), 11, "type=\"BSDF\" nodedef=\"ND_mine\"");
  EXPECT_THAT(ErrorOf(defined), HasSubstr("'ND_mine'"));
}

TEST(PbrtParameters, WhatChangesThemFromOutside) {
  const std::string lobe =
      "MakeNamedMaterial \"m\" \"string type\" \"conductor\" \"float roughness\" .4 \"rgb reflectance\" ";
  const std::string grey = lobe + "[.5 .5 .5]\n";
  EXPECT_EQ(ErrorOf("ColorSpace \"srgb\"\n" + grey), "no error");
  EXPECT_THAT(ErrorOf("ColorSpace \"aces2065-1\"\n" + grey), HasSubstr("the colour space is 'aces2065-1'"));
  EXPECT_THAT(ErrorOf("Attribute \"material\" \"bool remaproughness\" false\n" + grey),
              HasSubstr("line 1: an Attribute for materials"));
  EXPECT_EQ(ErrorOf("Attribute \"shape\" \"float radius\" 2\n" + grey), "no error");
  EXPECT_THAT(Import("Include \"metals.pbrt\"\n" + grey).remarks,
              testing::Contains("the file 'metals.pbrt' of line 1 was not looked into"));
  EXPECT_THAT(ErrorOf(grey + grey), HasSubstr("line 2: the material 'm' is defined twice"));
  EXPECT_THAT(ErrorOf(lobe + "[-.5 .5 .5]"), HasSubstr("reflectance holds -0.5"));
  EXPECT_THAT(Import(lobe + "[1.5 .5 .5]").remarks, testing::Contains(HasSubstr("of line 1 is above 1")));
  EXPECT_THAT(ErrorOf(grey + "\"float vroughness\" [.2 .3]"), HasSubstr("'vroughness' has 2 values"));
  EXPECT_THAT(ErrorOf(grey + "Material \"mix\" \"string materials\" [\"m\" \"m\"] \"float amount\" 1.5"),
              HasSubstr("the amount is 1.5"));
}

TEST(PbrtParameters, CountOrAreErrors) {
  const std::string lobe = "MakeNamedMaterial \"m\" \"string type\" \"conductor\" \"rgb reflectance\" [.5 .5 .5]\n";
  EXPECT_THAT(ErrorOf(lobe + "\"float uroughnes\" .2"), HasSubstr("did you mean 'uroughness'?"));
  EXPECT_THAT(ErrorOf(lobe + "\"float uroughnes\" .2"), HasSubstr("line 2"));
  EXPECT_THAT(ErrorOf(lobe), HasSubstr("perfect mirror")) << "the default roughness";
  EXPECT_THAT(ErrorOf(lobe + "\"texture roughness\" \"t\""), HasSubstr("is of the type 'texture'"));
  EXPECT_THAT(ErrorOf(lobe + "\"float roughness\" .2 \"float roughness\" .3"), HasSubstr("given twice"));
  EXPECT_THAT(ErrorOf(lobe + "\"float roughness\" .2 \"rgb eta\" [1 1 1]"), HasSubstr("not both"));
  EXPECT_THAT(ErrorOf(lobe + "\"float roughness\" .2 \"bool remaproughness\" flase"),
              HasSubstr("neither true nor false"));
  const ImportedMaterial two =
      Import("MakeNamedMaterial \"first\" \"string type\" \"diffuse\"\n" + lobe + "\"float roughness\" .2");
  EXPECT_THAT(two.remarks, testing::Contains(HasSubstr("'first' of line 1 is left out")));
}

std::string MitsubaScene(const char* version, const std::string& properties, const std::string& before = "") {
  return std::string("<scene version=\"") + version + "\">" + before +
         "<bsdf type=\"roughconductor\" id=\"last\"><string name=\"distribution\" value=\"ggx\"/>" + properties +
         "</bsdf></scene>";
}

TEST(MitsubaProperties, CountOrAreErrors) {
  const std::string old_names = "<float name=\"alphaU\" value=\"0.3\"/><float name=\"alphaV\" value=\"0.3\"/>";
  const std::string names = "<float name=\"alpha_u\" value=\"0.3\"/><float name=\"alpha_v\" value=\"0.3\"/>";
  EXPECT_EQ(ValuesOf(Import(MitsubaScene("0.6.0", old_names))), ValuesOf(Import(MitsubaScene("3.0.0", names))));
  EXPECT_NE(ValuesOf(Import(MitsubaScene("3.0.0", ""))), ValuesOf(Import(MitsubaScene("3.0.0", names))));
  EXPECT_THAT(ErrorOf(MitsubaScene("3.0.0", old_names)), HasSubstr("name=\"alphaU\""));
  EXPECT_THAT(ErrorOf(MitsubaScene("3.0.0", "<float name=\"alpha_u\" value=\"0.3\"/>")), HasSubstr("both alpha_u and"));
  EXPECT_THAT(ErrorOf(MitsubaScene("3.0.0", "<float name=\"int_ior\" value=\"1.3\"/>")), HasSubstr("int_ior"));
  const ImportedMaterial two = Import(MitsubaScene("3.0.0", names, "<bsdf type=\"diffuse\" id=\"first\"/>"));
  EXPECT_THAT(two.remarks, testing::Contains(HasSubstr("'first' of line 1 is left out: the last one, 'last'")));
}

TEST(MitsubaProperties, AreConstantsOfTheirType) {
  const auto error = [](const std::string& property) { return ErrorOf(MitsubaScene("0.6.0", property)); };
  EXPECT_THAT(error("<srgb name=\"k\" value=\"0.5, 0.5, 0.5\"/>"), HasSubstr("'k' is given by <srgb>"));
  EXPECT_THAT(error("<string name=\"alpha\" value=\"0.5\"/>"), HasSubstr("'alpha' is given by <string>"));
  EXPECT_THAT(error("<spectrum name=\"k\" value=\"1.5\" scale=\"2\"/>"), HasSubstr("scale='2' of 'k'"));
  EXPECT_THAT(error("<float name=\"alpha\" value=\"-0.5\"/>"), HasSubstr("not above 0"));
  EXPECT_THAT(ErrorOf("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"2\"/><bsdf type=\"diffuse\"/><bsdf "
                      "type=\"diffuse\"/></bsdf>"),
              HasSubstr("its weight is 2"));
  const ImportedMaterial shape =
      Import(MitsubaScene("3.0.0", "", "<shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape>"));
  EXPECT_THAT(shape.remarks, testing::Contains(HasSubstr("within the shape of line 1 is left out")));
}

TEST(GltfMembers, WhatConcernsTheWholeFile) {
  const auto gltf = [](const std::string& version, const std::string& more, const std::string& factor) {
    return "{\"asset\": {\"version\": \"" + version + "\"}" + more +
           ", \"materials\": [{\"pbrMetallicRoughness\": {\"roughnessFactor\": " + factor + "}}]}";
  };
  EXPECT_EQ(ErrorOf(gltf("2.0", "", "0.5")), "no error");
  EXPECT_THAT(ErrorOf(gltf("1.0", "", "0.5")), HasSubstr("of the version 1.0"));
  EXPECT_THAT(ErrorOf(gltf("2.0", ", \"extensionsRequired\": [\"KHR_materials_volume\"]", "0.5")),
              HasSubstr("requires the extension 'KHR_materials_volume'"));
  EXPECT_THAT(ErrorOf(gltf("2.0", "", "-0.5")), HasSubstr("'roughnessFactor' is -0.5; 0 to 1"));
  EXPECT_THAT(ErrorOf(std::string("glTF\2\0\0\0", 8)), HasSubstr("binary form"));
}

// Numbers that a renderer refuses, and what stands beside the material.
TEST(ForeignInputs, OutOfRangeOrBesideTheMaterial) {
  const auto gltf = [](const std::string& material, const std::string& more = "") {
    return "{\"asset\": {\"version\": \"2.0\"}" + more + ", \"materials\": [" + material + "]}";
  };
  EXPECT_THAT(ErrorOf(gltf("{\"pbrMetallicRoughness\": {\"baseColorFactor\": [2, 1, 1, 1]}}")),
              HasSubstr("'baseColorFactor' holds 2; 0 to 1 is allowed"));
  EXPECT_THAT(ErrorOf(gltf("{\"extensions\": {\"KHR_materials_specular\": {\"specularColorFactor\": [-1, 1, 1]}}}")),
              HasSubstr("'specularColorFactor' holds -1"));
  EXPECT_THAT(ErrorOf(gltf("{\"extensions\": {\"KHR_materials_ior\": {\"ior\": 0.5}}}")), HasSubstr("'ior' is 0.5"));
  EXPECT_EQ(ErrorOf(gltf("{\"extensions\": {\"KHR_materials_ior\": {\"ior\": 0}}}")), "no error");
  const std::string mesh = ", \"meshes\": [{\"primitives\": [{\"attributes\": {\"COLOR_0\": 1}}]}]";
  EXPECT_THAT(Import(gltf("{}", mesh)).remarks, testing::Contains(HasSubstr("COLOR_0")));

  EXPECT_THAT(ErrorOf("<scene version=\"3.0.0\"><bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"2 2 2\"/>"
                      "</bsdf></scene>"),
              HasSubstr("its reflectance holds 2; 0 to 1 is allowed"));
  EXPECT_THAT(Import(MitsubaScene("3.0.0", "", "<include filename=\"other.xml\"/>")).remarks,
              testing::Contains("the file 'other.xml' of line 1 was not looked into"));

  EXPECT_THAT(ErrorOf(Conductor(Input("weight", "float", "2"))), HasSubstr("its weight is 2"));
  EXPECT_THAT(ErrorOf(Conductor("", "<conductor_bsdf name=\"b\" type=\"BSDF\"/>")), HasSubstr("'b' is given twice"));
  EXPECT_THAT(Import(Conductor("", "<xi:include href=\"other.mtlx\"/>")).remarks,
              testing::Contains("the file 'other.mtlx' of line 1 was not looked into"));

  EXPECT_THAT(ErrorOf("MakeNamedMaterial \"m\" \"string type\" \"conductor\" \"rgb reflectance\" [.5 .5 .5] "
                      "\"float roughness\" -.3"),
              HasSubstr("uroughness is -0.3; 0 and more"));
}

TEST(GltfMembers, CountOrAreErrors) {
  const auto gltf = [](const std::string& material) {
    return "{\"asset\": {\"version\": \"2.0\"}, \"materials\": [" + material + "]}";
  };
  // Every default of the format: a white metal of roughness 1.
  const ImportedMaterial defaults = Import(gltf("{}"));
  EXPECT_EQ(ValuesOf(defaults), ValuesOf(Import(gltf("{\"pbrMetallicRoughness\": {\"roughnessFactor\": 1}}"))));
  EXPECT_THAT(ErrorOf(gltf("{\"extensions\": {\"KHR_materials_pbrSpecularGlossiness\": {}}}")),
              HasSubstr("'KHR_materials_pbrSpecularGlossiness'"));
  for (const char* extension : {"KHR_materials_iridescence", "KHR_materials_sheen", "KHR_materials_transmission"}) {
    EXPECT_THAT(ErrorOf(gltf(std::string("{\"extensions\": {\"") + extension + "\": {}}}")), HasSubstr(extension));
  }
  EXPECT_THAT(ErrorOf(gltf("{\"extensions\": {\"KHR_materials_anisotropy\": {\"anisotropyTexture\": {}}}}")),
              HasSubstr("has textures ('anisotropyTexture')"));
  EXPECT_THAT(ErrorOf(gltf("{\"extensions\": {\"KHR_materials_clearcoat\": {\"clearcoatNormalTexture\": {}}}}")),
              HasSubstr("has textures ('clearcoatNormalTexture')"));
  const std::string coat =
      "{\"extensions\": {\"KHR_materials_clearcoat\": {\"clearcoatFactor\": 1, "
      "\"clearcoatRoughnessFactor\": 0.3}}}";
  EXPECT_NE(ValuesOf(Import(gltf(coat))), ValuesOf(defaults));
  EXPECT_THAT(ErrorOf(gltf("{\"occlusionTexture\": {}}")), HasSubstr("has textures ('occlusionTexture')"));
  EXPECT_THAT(ErrorOf(gltf("{\"alphaMode\": \"BLEND\"}")), HasSubstr("not opaque"));
  EXPECT_THAT(ErrorOf(gltf("{\"emissiveFactor\": [1, 0, 0]}")), HasSubstr("emits"));
  EXPECT_THAT(ErrorOf(gltf("{\"pbrMetallicRoughness\": {\"roughness\": 0.2}}")), HasSubstr("'roughness'"));
  EXPECT_THAT(Import(gltf("{\"name\": \"a\"}, {\"name\": \"b\"}")).remarks,
              testing::Contains("the material 1 ('b') is left out: the first one, 'a', is taken"));
}

// A table without reciprocity: each half of the turn of phi_d has its own value.
TEST(MerlLookup, TakesTablesOfAWholeTurn) {
  constexpr std::size_t kCells = 90 * 90 * 360;
  std::string bytes(12 + 3 * 8 * kCells, '\0');
  const std::int32_t dims[3] = {90, 90, 360};
  std::memcpy(bytes.data(), dims, sizeof(dims));
  for (std::size_t cell = 0; cell < 3 * kCells; ++cell) {
    const double value = cell % 360 < 180 ? 150 : 300;
    std::memcpy(bytes.data() + 12 + 8 * cell, &value, 8);
  }
  const TemporaryFile file(bytes);
  const ImportedMaterial table = ImportMaterial(file.path());
  EXPECT_EQ(table.format, "merl");
  double there[3] = {}, back[3] = {};
  Vec3 wi, wo;
  FromHalfDifference({0.3, 0, 0.4, 1.0}, &wi, &wo);
  table.brdf(wi, wo, there);
  table.brdf(wo, wi, back);
  EXPECT_NEAR(there[0], 0.1, 1e-12);
  EXPECT_NEAR(back[0], 0.2, 1e-12);
}

}  // namespace
}  // namespace lobefit
