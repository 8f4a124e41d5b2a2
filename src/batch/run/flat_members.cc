#include "lobefit/batch/run/flat_members.h"

#include <utility>

#include <rapidjson/reader.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// Whether the text holds half a character: an escape can name one (U+D800 to U+DFFF), which the parser writes as bytes
// that are no UTF-8.
bool HoldsHalf(std::string_view text) {
  for (std::size_t at = text.find('\xED'); at < text.size(); at = text.find('\xED', at + 1)) {
    if (at + 1 < text.size() && static_cast<unsigned char>(text[at + 1]) >= 0xA0) return true;
  }
  return false;
}

// Members as the parser meets them, each a part of the text that it parses in place. False ends the parsing: of nested
// values, and of what is no object.
class MemberReader : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, MemberReader> {
 public:
  explicit MemberReader(std::vector<FlatMember>* members) : members_(*members) {}

  bool Default() { return false; }
  bool Null() { return Take("null", FlatMember::Kind::kNull); }
  bool Bool(bool value) { return Take(value ? "true" : "false", FlatMember::Kind::kBoolean); }
  bool RawNumber(const char* text, rapidjson::SizeType length, bool) {
    return Take({text, length}, FlatMember::Kind::kNumber);
  }
  bool String(const char* text, rapidjson::SizeType length, bool) {
    return !HoldsHalf({text, length}) && Take({text, length}, FlatMember::Kind::kString);
  }
  bool StartObject() { return !std::exchange(is_within_, true); }
  bool Key(const char* text, rapidjson::SizeType length, bool) {
    members_.emplace_back().name = {text, length};
    return !HoldsHalf({text, length});
  }
  bool EndObject(rapidjson::SizeType) { return true; }

 private:
  bool Take(std::string_view value, FlatMember::Kind kind) {
    if (!is_within_) return false;
    members_.back().value = value;
    members_.back().kind = kind;
    return true;
  }

  std::vector<FlatMember>& members_;
  bool is_within_ = false;
};

}  // namespace

FlatMembers::FlatMembers(std::string_view text) : text_(text) {
  constexpr unsigned kFlags =
      rapidjson::kParseInsituFlag | rapidjson::kParseNumbersAsStringsFlag | rapidjson::kParseValidateEncodingFlag;
  MemberReader handler(&members_);
  rapidjson::Reader reader;
  rapidjson::InsituStringStream stream(text_.data());
  // The parser takes a zero for the end.
  if (text.find('\0') != std::string_view::npos || !reader.Parse<kFlags>(stream, handler))
    throw InputError("'" + Excerpt(text) + "' is no JSON object without nested ones");
}

}  // namespace lobefit
