// Members of a JSON object that holds no other object or array, as journals and tables have them by the hundred
// thousand: read in one pass, without a tree.
#pragma once

#include <string>
#include <string_view>

namespace lobefit {

// Walks over the members in order. Numbers, true, false and null come as they are written, strings without their quotes
// and escapes.
class FlatJson {
 public:
  enum class Kind { kNull, kBoolean, kNumber, kString };

  explicit FlatJson(std::string_view text) : text_(text) {}
  // False after the last member. Throws InputError for text that is no such object, at the latest after its last member.
  bool Next();
  // Of the member that Next gave last; valid until the next call.
  std::string_view name() const { return name_; }
  std::string_view value() const { return value_; }
  Kind kind() const { return kind_; }

 private:
  [[noreturn]] void Fail() const;
  void SkipBlanks();
  void Expect(char c);
  std::string_view String(std::string* unescaped);
  void Value();

  std::string_view text_, name_, value_;
  std::string name_text_, value_text_;  // where there were escapes
  std::size_t at_ = 0;
  Kind kind_ = Kind::kNull;
  bool begun_ = false;
};

}  // namespace lobefit
