// Reading a measurement file: the format is recognised by content, what the file leaves open is filled by options.
#pragma once

#include <filesystem>

#include "lobefit/io/text/format.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// The reader that recognises the bytes. Throws InputError that lists the known formats.
const Format& RecogniseFormat(const InputFile& file);

// Maps, recognises and reads a file; sets Measurement::format, source and sha256. Throws InputError for a file that
// cannot be read, is not valid, or has no usable sample.
Measurement ReadMeasurement(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace lobefit
