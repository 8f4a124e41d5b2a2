// Recognises the format by content, and reads it.
#pragma once

#include <string_view>

#include "lobefit/io/text/format.h"

namespace lobefit {

bool IsCsv(std::string_view bytes);
// Whether a line of names has one of a direction, even where nothing usable follows: a measurement, and no other table
// or prose with commas.
bool NamesDirections(const InputFile& file);
// Throws InputError with the place in the file.
Measurement ReadCsv(const InputFile& file, const ReadOptions& options);

}  // namespace lobefit
