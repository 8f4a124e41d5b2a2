#include "lobefit/batch/run/flat_members.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

// Members as the parser meets them. False ends the parsing: of nested values, and of what is no object.
class MemberReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit MemberReader(std::vector<FlatMember>* members) : members_(*members) {}

  bool null() override { return Take("null", FlatMember::Kind::kNull); }
  bool boolean(bool value) override { return Take(value ? "true" : "false", FlatMember::Kind::kBoolean); }
  bool number_integer(number_integer_t value) override {
    return Take(std::to_string(value), FlatMember::Kind::kNumber);
  }
  bool number_unsigned(number_unsigned_t value) override {
    return Take(std::to_string(value), FlatMember::Kind::kNumber);
  }
  bool number_float(number_float_t, const string_t& text) override { return Take(text, FlatMember::Kind::kNumber); }
  bool string(string_t& value) override { return Take(std::move(value), FlatMember::Kind::kString); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return !std::exchange(is_within_, true); }
  bool key(string_t& name) override {
    members_.emplace_back().name = std::move(name);
    return true;
  }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return false; }
  bool end_array() override { return false; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool Take(std::string value, FlatMember::Kind kind) {
    if (!is_within_) return false;
    members_.back().value = std::move(value);
    members_.back().kind = kind;
    return true;
  }

  std::vector<FlatMember>& members_;
  bool is_within_ = false;
};

}  // namespace

std::vector<FlatMember> FlatMembers(std::string_view text) {
  std::vector<FlatMember> members;
  MemberReader reader(&members);
  if (!nlohmann::json::sax_parse(text, &reader))
    throw InputError("'" + Excerpt(text) + "' is no JSON object without nested ones");
  return members;
}

}  // namespace lobefit
