// Reading a measurement file: the format is recognised by content, what the file leaves open is filled by options.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lobefit/io/text/format.h"
#include "lobefit/measurement/measurement.h"

namespace lobefit {

// The reader that recognises the bytes. Throws InputError that lists the known formats.
const Format& RecogniseFormat(const InputFile& file);

// Whether a file of a folder is meant: what some reader recognises, and of rows with separators, which any text may
// have, those whose names hold directions, unless `any_rows` (--columns names them). True for a file that cannot be
// opened, so that it is missed.
bool HoldsMeasurement(const std::filesystem::path& path, bool any_rows);

// Reads, recognises and finishes a file. Throws InputError for a file that cannot be read, is not valid, or has no
// usable sample.
Measurement ReadMeasurement(const std::filesystem::path& path, const ReadOptions& options = {});

// The two halves of it, for measurements of several files: what one file holds, with format, source and sha256
// (channels may lack values in some samples); and what concerns all samples: channels are chosen and samples without a
// value in them set aside, zones excluded, noise treated, conventions checked.
Measurement ReadPart(const std::filesystem::path& path, const ReadOptions& options);
Measurement FinishReading(Measurement measurement, const ReadOptions& options);

// Options with keys of the file's own, as FILE:KEY=VALUE states them.
ReadOptions WithKeys(ReadOptions options, const std::vector<std::string>& keys);

}  // namespace lobefit
