// Pieces of text that the exporters share.
#pragma once

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
// Three of them with blanks between.
std::string Numbers9(const Color3& values, std::string_view separator = " ");

// Comment lines, each behind `mark`; or as one XML comment, in which two hyphens are set apart.
std::string CommentLines(const std::vector<std::string>& lines, std::string_view mark);
std::string XmlComment(const std::vector<std::string>& lines);

// The comment of formats that have no rotation of their own: by how much the mesh's texture coordinates are to be
// turned. The reader of our exports takes the angle (radians) from it; 0 where it is not there.
std::vector<std::string> RotationComment(double rotation);
double RotationOfComment(std::string_view text);

// For pbrt and Mitsuba, whose lobes all take the mesh's tangent: the rotation of the strongest lobe that has one.
double CommonRotation(const FittedBrdf& fit);

// A name that formats and programs take: letters, digits, underscores.
std::string Identifier(const std::string& name);

}  // namespace lobefit
