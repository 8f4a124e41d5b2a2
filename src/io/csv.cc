#include "lobefit/io/formats.h"
namespace lobefit {
bool IsCsv(std::string_view) { return false; }
Measurement ReadCsv(const InputFile&, const ReadOptions&) { return {}; }
}  // namespace lobefit
