#include "lobefit/io/wrong_kind.h"

#include <array>

#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

struct Kind {
  std::string_view begin;
  const char* message;
};

constexpr auto kKinds = std::to_array<Kind>({
    {"version https://git-lfs.github.com/spec",
     "is a pointer of Git LFS, not the file itself; run 'git lfs pull' in its repository, or download the file from "
     "its page"},
    {"%PDF-", "is a PDF document; export the table that it shows as CSV"},
    {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1",
     "is an old Office document (.xls, .doc); save the sheet as CSV (comma delimited)"},
    {"7z\xbc\xaf\x27\x1c", "is a 7-Zip archive; unpack it and name the file within"},
    {"Rar!", "is a RAR archive; unpack it and name the file within"},
    {"BZh", "is packed by bzip2; unpack it with bunzip2"},
    {"\xfd"
     "7zXZ",
     "is packed by xz; unpack it with unxz"},
    {"\x28\xb5\x2f\xfd", "is packed by zstd; unpack it with unzstd"},
    {"\x89PNG\r\n", "is a PNG picture, which holds no f_r; values from a plot must be read off and written as CSV"},
    {"\xff\xd8\xff", "is a JPEG picture, which holds no f_r; values from a plot must be read off and written as CSV"},
    {"GIF8", "is a GIF picture, which holds no f_r"},
    {std::string_view("II*\0", 4),
     "is a TIFF picture; only OpenEXR pictures are read, convert it and say its axes with --exr-axes"},
    {"#?RADIANCE",
     "is a Radiance picture; only OpenEXR pictures are read, convert it and say its axes with --exr-axes"},
    {"\x89HDF\r\n", "is an HDF5 file (also .mat of MATLAB 7.3, netCDF 4); export the arrays as CSV rows"},
    {"CDF\x01", "is a netCDF file; export the arrays as CSV rows"},
    {"CDF\x02", "is a netCDF file; export the arrays as CSV rows"},
    {"\x93NUMPY",
     "is a NumPy array; write it as CSV with a line of names: numpy.savetxt(name, rows, delimiter=',', "
     "header='theta_i,phi_i,theta_o,phi_o,brdf')"},
    {"MATLAB 5.0 MAT-file", "is a MATLAB file; write the table as CSV: writetable(T, 'name.csv')"},
    {"MATLAB 7.3 MAT-file", "is a MATLAB file; write the table as CSV: writetable(T, 'name.csv')"},
    {"{\\rtf", "is a rich-text document; save it as plain text"},
    {"SQLite format 3", "is an SQLite database; export the table as CSV"},
    {"\x80\x04\x95", "is a Python pickle; write the table as CSV"},
    {"PAR1", "is a Parquet file; write the table as CSV"},
    {std::string_view("MM\0*", 4),
     "is a TIFF picture; only OpenEXR pictures are read, convert it and say its axes with --exr-axes"},
    {"%!PS", "is a PostScript document; export the table that it shows as CSV"},
    {"CPYA", "is an Origin project; export the worksheet as ASCII: File, Export"},
    {"CPYUA", "is an Origin project; export the worksheet as ASCII: File, Export"},
    {"RDX2\n", "is an R workspace; write the table as CSV: write.csv(table, 'name.csv')"},
    {"RDX3\n", "is an R workspace; write the table as CSV: write.csv(table, 'name.csv')"},
    {"\x7f"
     "ELF",
     "is a program, not a measurement"},
    {"MZ\x90", "is a program, not a measurement"},
    {"IESNA", "is a photometric file of a luminaire (IES), whose intensities are no f_r"},
    {"TracePro Surface Property Data",
     "is a surface property of TracePro; write the rows of its Table_BSDF_Data as CSV with the columns "
     "theta_i,phi_i,theta_o,phi_o,brdf (its ScatterBeta is |beta - beta0| about the mirror direction)"},
    {"OPTIS - ",
     "is a surface file of Speos; convert it to Zemax' or LightTools' .bsdf, or write its tables as CSV with the "
     "columns "
     "theta_i,phi_i,theta_o,phi_o,brdf"},
    {"DataType:\tBRDF(",
     "is an export of a goniometer (.jdv); export it for Zemax, or write one row a value as CSV with the columns "
     "theta_i,phi_i,theta_o,phi_o,brdf"},
    {"Name / Comment :",
     "is an export of a Reflet goniometer; export it for Zemax, or write one row a value as CSV with the columns "
     "theta_i,phi_i,theta_o,phi_o,brdf"},
    {"IGOR\n", "is an Igor Text file; save the waves as delimited text: Data, Save Waves, Save Delimited Text"},
    {"PE UV ", "is a spectrum of PerkinElmer, which has no directions"},
    {"CGATS.17", "is a CGATS file of colours, which has no directions of light and viewer"},
    {"SpectraSuite Data File", "is a spectrum of Ocean Optics, which has no directions"},
    {"##TITLE=", "is a JCAMP-DX spectrum, which has no directions"},
    {"/annex/objects/",
     "is a pointer of git-annex, not the file itself; run 'git annex get' in its repository, or download the file from "
     "its page"},
    {std::string_view("\xff\xfe\0\0", 4), "is UTF-32 text; save it as UTF-8"},
    {std::string_view("\0\0\xfe\xff", 4), "is UTF-32 text; save it as UTF-8"},
});

bool Holds(std::string_view bytes, std::string_view part) {
  return bytes.substr(0, 4096).find(part) != std::string_view::npos;
}

std::string DescribeZip(std::string_view bytes) {
  if (Holds(bytes, "xl/") || Holds(bytes, "[Content_Types].xml"))
    return "is an Excel workbook (.xlsx) or another Office document; save the sheet as CSV: File, Save as, CSV UTF-8";
  if (Holds(bytes, "opendocument.spreadsheet"))
    return "is an OpenDocument spreadsheet (.ods); save the sheet as CSV: File, Save as, Text CSV";
  if (Holds(bytes, ".npy")) return "is a NumPy archive (.npz); write its arrays as CSV rows with a line of names";
  return "is a zip archive; unpack it and name the file within";
}

// `head`: the beginning of XML or JSON, in small letters.
std::string DescribeMarkup(std::string_view head) {
  const auto has = [&](std::string_view part) { return head.find(part) != std::string_view::npos; };
  if (has("<svg")) return "is an SVG picture, which holds no f_r; export the table that it shows as CSV";
  if (has("excel.sheet") || has("office:spreadsheet"))
    return "is an Excel workbook in XML; save the sheet as CSV: File, Save as, CSV UTF-8";
  if (has("<error>") && has("<code>"))
    return "is a server's message that the file cannot be had, not a measurement; look for another link";
  if (has("<scene ") || has("<materialx"))
    return "is a renderer's material, not a measurement; `lobefit compare FILE --with` sets it beside one";
  if (has("<cc:cxf") || has("colorexchangeformat"))
    return "is a CxF file of colours; write one row a value as CSV with the columns theta_i,theta_o,brdf";
  if (has("\"lobefit material\""))
    return "is a material document, not a measurement; `lobefit compare FILE --with` sets it beside one, "
           "`lobefit synth` makes a measurement of it";
  return "";
}

}  // namespace

std::string DescribeWrongKind(std::string_view bytes) {
  for (const Kind& kind : kKinds) {
    if (bytes.starts_with(kind.begin)) return kind.message;
  }
  if (bytes.starts_with("PK\x03\x04") || bytes.starts_with("PK\x05\x06")) return DescribeZip(bytes);
  const std::string head = ToLower(Trim(bytes.substr(0, 1024)));
  const bool html = head.starts_with("<!doctype html") || head.starts_with("<html") || head.starts_with("<head>") ||
                    head.starts_with("<head ") || head.starts_with("<a href") ||
                    (head.starts_with("<!--") && head.find("<html") != std::string::npos) ||
                    (head.starts_with("<?xml") && head.find("<html") != std::string::npos);
  const bool missing = head.size() < 40 && (head == "not found" || head.starts_with("404: not found"));
  if (html || missing)
    return "is a web page, not a measurement: the link led to a page about the file (or asked to log in); download the "
           "raw file";
  if (bytes.size() > 512 && bytes.substr(257, 5) == "ustar")
    return "is a tar archive; unpack it and name the file within";
  return head.starts_with('<') || head.starts_with('{') ? DescribeMarkup(head) : "";
}

}  // namespace lobefit
