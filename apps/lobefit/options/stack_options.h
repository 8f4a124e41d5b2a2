// Image stacks on the command line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lobefit {

// NAME of a stack's results: that of the folder; of a file, its own, or its folder's for a stack.toml.
std::string StackName(const std::filesystem::path& stack);

// "3,17" as indices from 0. Throws UsageError that names the option.
std::vector<std::size_t> ParseLights(const std::string& text, const char* option, std::size_t lights);

}  // namespace lobefit
