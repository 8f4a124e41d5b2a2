// Recognises the format by content, and reads it.
#pragma once

#include <string_view>

#include "lobefit/io/text/format.h"

namespace lobefit {

bool IsAstm(std::string_view bytes);
// Throws InputError with the place in the file.
Measurement ReadAstm(const InputFile& file, const ReadOptions& options);

}  // namespace lobefit
