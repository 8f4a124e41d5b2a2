// Files of other kinds are named as what they are, with what to do about it.
#include "lobefit/io/wrong_kind.h"

#include <string>
#include <utility>
#include <vector>

#include "tests/io/csv/read_csv.h"
#include <gmock/gmock.h>

namespace lobefit {
namespace {

std::string TarHeader() {
  std::string header(600, '\0');
  header.replace(0, 8, "scan.csv");
  header.replace(257, 5, "ustar");
  return header;
}

TEST(WrongKind, IsNamedAsWhatItIs) {
  const std::string xml = "<?xml version=\"1.0\"?>\n";
  const std::vector<std::pair<std::string, std::string>> files = {
      {"<a href=\"https://x.org/data.csv\">Moved Permanently</a>.\n", "web page"},
      {"404: Not Found", "web page"},
      {xml + "<Error><Code>AccessDenied</Code></Error>", "server's message"},
      {xml + "<svg xmlns=\"http://www.w3.org/2000/svg\">", "SVG picture"},
      {xml + "<?mso-application progid=\"Excel.Sheet\"?>\n<Workbook>", "Excel workbook in XML"},
      {xml + "<materialx version=\"1.38\">", "renderer's material"},
      {"<scene version=\"3.0.0\"><bsdf type=\"diffuse\"/></scene>", "renderer's material"},
      {"{\"format\": \"lobefit material\", \"format_version\": \"1.0\"}", "material document"},
      {std::string("MM\0*\0\0\0\x08", 8), "TIFF"},
      {"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon HDF5 schema 1.00 .", "writetable"},
      {"CPYUA 4.3400 200 W64 #\n", "Origin project"},
      {"IESNA:LM-63-2002\n[TEST] x\nTILT=NONE\n", "luminaire"},
      {"TracePro Surface Property Data\nFile Name\tx\n", "TracePro"},
      {"OPTIS - Anisotropic BSDF surface file v7.0\n0\n", "Speos"},
      {"DataType:\tBRDF(RT-300S)\t \t\rSampleID:\tSample 0\r", ".jdv"},
      {"Name / Comment :\tA1\t\nDate:\t1/1/2020\n", "Reflet"},
      {"IGOR\nWAVES/D theta\n", "Igor"},
      {"CGATS.17\nORIGINATOR \"x\"\n", "CGATS"},
      {xml + "<cc:CxF xmlns:cc=\"http://colorexchangeformat.com/CxF3-core\">", "CxF"},
      {"##TITLE= Sample\n##JCAMP-DX= 4.24\n", "JCAMP-DX"},
      {"/annex/objects/MD5E-s123--abc.csv\n", "git annex get"},
      {TarHeader(), "tar archive"},
      {std::string("\xff\xfe\0\0t\0\0\0", 8), "UTF-32"},
  };
  for (const auto& [bytes, kind] : files)
    EXPECT_THAT(MessageOf(bytes), testing::HasSubstr(kind)) << bytes.substr(0, 40);
}

TEST(WrongKind, WordsThatOnlyBeginLikeOneAreRead) {
  for (const char* head : {"<header>\nSample: A1\n</header>\n", "MATLAB export of a scan\n", "MM 1 of the series\n"})
    EXPECT_EQ(ReadText(std::string(head) + "theta_i,theta_o,brdf\n10,20,1\n30,40,2\n").samples.size(), 2U) << head;
}

}  // namespace
}  // namespace lobefit
