// Members of a JSON object that holds no other object or array, as segments and tables have them by the hundred
// thousand: without a tree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

struct FlatMember {
  enum class Kind { kNull, kBoolean, kNumber, kString };

  std::string name, value;  // numbers, true, false and null as they are written, strings without their escapes
  Kind kind = Kind::kNull;
};

// In their order. Throws InputError for text that is no such object.
std::vector<FlatMember> FlatMembers(std::string_view text);

}  // namespace lobefit
