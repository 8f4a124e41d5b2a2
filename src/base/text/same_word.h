// Words looked up in lists of hundreds: lengths and first letters mostly differ, so that few are compared as a whole.
#pragma once

#include <string_view>

namespace lobefit {

inline bool SameWord(std::string_view a, std::string_view b) {
  return a.size() == b.size() && (a.empty() || (a.front() == b.front() && a == b));
}

inline bool BeginsWith(std::string_view text, std::string_view head) {
  return head.empty() || (text.size() >= head.size() && text.front() == head.front() && text.starts_with(head));
}

}  // namespace lobefit
