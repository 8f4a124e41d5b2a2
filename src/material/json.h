// *.material.json: writing, and strict reading with the place of what is wrong. The schema is
// src/material/material.schema.json.
#pragma once

#include <filesystem>
#include <string>

#include "lobefit/material/material.h"

namespace lobefit {

// The document, indented by two blanks, numbers with 17 significant digits where needed, NaN as null.
std::string ToJson(const Material& material);

// Throws InputError that names the file and the member.
Material MaterialFromJson(const std::string& text, const std::string& file_name);
Material ReadMaterial(const std::filesystem::path& path);
// ReadMaterial for those who need a model: also throws InputError for a document that holds a table of lobes.
Material ReadModelMaterial(const std::filesystem::path& path);
// True where the file begins like a document of a material, whether it is a valid one or not.
bool LooksLikeMaterial(const std::filesystem::path& path);
void WriteMaterial(const Material& material, const std::filesystem::path& path);

}  // namespace lobefit
