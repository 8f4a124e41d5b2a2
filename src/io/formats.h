// The table of formats that can be read: a new format is one source file and one row here.
#pragma once

#include <vector>

#include "lobefit/io/read.h"

namespace lobefit {

// In the order of recognition: formats with a magic number first, then by size, then text formats from strict to loose.
const std::vector<Format>& Formats();

// Each reader is in the source file of its name.
bool IsMerl(std::string_view bytes);
Measurement ReadMerl(const InputFile& file, const ReadOptions& options);
bool IsExr(std::string_view bytes);
Measurement ReadExr(const InputFile& file, const ReadOptions& options);
bool IsMit(std::string_view bytes);
Measurement ReadMit(const InputFile& file, const ReadOptions& options);
bool IsUtia(std::string_view bytes);
Measurement ReadUtia(const InputFile& file, const ReadOptions& options);
bool IsRgl(std::string_view bytes);
Measurement ReadRgl(const InputFile& file, const ReadOptions& options);
bool IsBsdfXml(std::string_view bytes);
Measurement ReadBsdfXml(const InputFile& file, const ReadOptions& options);
bool IsZemax(std::string_view bytes);
Measurement ReadZemax(const InputFile& file, const ReadOptions& options);
bool IsLightTools(std::string_view bytes);
Measurement ReadLightTools(const InputFile& file, const ReadOptions& options);
bool IsFred(std::string_view bytes);
Measurement ReadFred(const InputFile& file, const ReadOptions& options);
bool IsMbsdf(std::string_view bytes);
Measurement ReadMbsdf(const InputFile& file, const ReadOptions& options);
bool IsAstm(std::string_view bytes);
Measurement ReadAstm(const InputFile& file, const ReadOptions& options);
bool IsMountain(std::string_view bytes);
Measurement ReadMountain(const InputFile& file, const ReadOptions& options);
bool IsAlta(std::string_view bytes);
Measurement ReadAlta(const InputFile& file, const ReadOptions& options);
bool IsCornell(std::string_view bytes);
Measurement ReadCornell(const InputFile& file, const ReadOptions& options);
bool IsCsv(std::string_view bytes);
Measurement ReadCsv(const InputFile& file, const ReadOptions& options);

}  // namespace lobefit
