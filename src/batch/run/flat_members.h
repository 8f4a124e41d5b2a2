// Members of a JSON object that holds no other object or array, as segments and tables have them by the hundred
// thousand: without a tree, and without a copy of each.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

struct FlatMember {
  enum class Kind { kNull, kBoolean, kNumber, kString };

  // Numbers, true, false and null as they are written, strings without their escapes.
  std::string_view name, value;
  Kind kind = Kind::kNull;
};

class FlatMembers {
 public:
  // In their order, valid as long as the object. Throws InputError for text that is no such object.
  explicit FlatMembers(std::string_view text);
  FlatMembers(const FlatMembers&) = delete;
  FlatMembers& operator=(const FlatMembers&) = delete;

  std::vector<FlatMember>::const_iterator begin() const { return members_.begin(); }
  std::vector<FlatMember>::const_iterator end() const { return members_.end(); }

 private:
  std::string text_;  // of which the members are parts
  std::vector<FlatMember> members_;
};

}  // namespace lobefit
