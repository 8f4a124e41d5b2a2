// Pieces of text that the exporters share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/renderer/surface.h"

namespace lobefit {

// Nine significant digits: what single precision holds.
std::string Number9(double value);
// The same as a literal of type float in shader text.
std::string FloatLiteral(double value);
// Several with blanks between.
std::string Numbers9(const std::vector<double>& values, std::string_view separator = " ");
std::string Numbers9(const Color3& values, std::string_view separator = " ");

// A literal of Python that is `text`, whatever stands in it; bytes that are not UTF-8 become '?'.
std::string PythonString(std::string_view text);

// Comment lines, each behind `mark` and made Printable; or as one XML comment, in which two hyphens are set apart.
std::string CommentLines(const std::vector<std::string>& lines, std::string_view mark);
std::string XmlComment(const std::vector<std::string>& lines);

// The comment of formats that have no rotation of their own: by how much the mesh's texture coordinates are to be
// turned. The reader of our exports takes the angle (radians) from it; 0 where it is not there.
std::vector<std::string> RotationComment(double rotation);
double RotationOfComment(std::string_view text);

// A line for the header of a file that names normal maps.
std::string MapComment(const std::vector<std::string>& maps, std::string_view beside);

// The file of a map that a material file names: in that file's folder by the whole name or, where a renderer looks
// elsewhere, by its last part. Throws InputError for what is no regular file, such as a device.
std::filesystem::path FindMap(const std::filesystem::path& file, const std::string& name);

// Names in GLSL of one material, so that several files make one shader: "lobefit_NAME_"; and the macro by which the
// first file of a shader is called without NAME: lobefit_`name` for `own`.
std::string GlslPrefix(const std::string& name);
std::string GlslShortName(const std::string& name, const std::string& own);

// A name that formats and programs take: letters, digits, underscores.
std::string Identifier(const std::string& name);

}  // namespace lobefit
