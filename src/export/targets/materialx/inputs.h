// The inputs of the MaterialX nodes that are understood.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace lobefit {

struct MaterialXInput {
  const char* name;
  // The only value that is understood, numbers with commas between or a word; null: any, because it is evaluated or has
  // no effect beside the others.
  const char* only = nullptr;
};

// By the name of the node.
const std::map<std::string, std::vector<MaterialXInput>>& MaterialXInputs();

}  // namespace lobefit
