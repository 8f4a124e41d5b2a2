// Text to an open file.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>

namespace lobefit {

// Has `write` write to the descriptor, which stays open. Throws OutputError that names `path` where the system refuses;
// what `write` throws passes through.
void Fill(int descriptor, const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

}  // namespace lobefit
