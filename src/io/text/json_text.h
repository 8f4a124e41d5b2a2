// JSON from strangers.
#pragma once

#include <string_view>

namespace lobefit {

// The document, or what `is_discarded` for text that is no JSON, a number beyond a double's range included, for which
// nlohmann_json throws even where it is told not to.
template <class Json>
Json ParseJson(std::string_view text) {
  try {
    return Json::parse(text.begin(), text.end(), nullptr, false);
  } catch (const typename Json::exception&) {
    return Json(Json::value_t::discarded);
  }
}

}  // namespace lobefit
