// Numbers as tables write them, fast: most of the time of reading a long text file is spent here.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace lobefit {
namespace internal {

// Appends the digits at text[*at] to *digits, eight characters at a time where so many are left, as many as there are
// up to `most`. Returns their count.
inline std::size_t TakeDigits(std::string_view text, std::size_t most, std::size_t* at, std::int64_t* digits) {
  const std::size_t begin = *at;
  if constexpr (std::endian::native == std::endian::little) {
    static constexpr std::array<std::int64_t, 9> kPowers = {1,      10,      100,      1000,     10000,
                                                            100000, 1000000, 10000000, 100000000};
    while (text.size() - *at >= 8 && *at - begin + 8 <= most) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, text.data() + *at, 8);
      bytes ^= 0x3030303030303030U;  // digits are 0 to 9 now
      const std::uint64_t others = ((bytes + 0x7676767676767676U) | bytes) & 0x8080808080808080U;
      const auto count = static_cast<unsigned>(std::countr_zero(others)) / 8;  // 8 where all are digits
      if (count == 0) break;
      // Zeros before the digits; then pairs, fours and eights of them.
      bytes <<= 8 * (8 - count);
      bytes = (bytes * 10 + (bytes >> 8)) & 0x00ff00ff00ff00ffU;
      bytes = (bytes * 100 + (bytes >> 16)) & 0x0000ffff0000ffffU;
      bytes = (bytes * 10000 + (bytes >> 32)) & 0x00000000ffffffffU;
      *digits = *digits * kPowers[count] + static_cast<std::int64_t>(bytes);
      *at += count;
      if (count < 8) return *at - begin;
    }
  }
  while (*at < text.size() && text[*at] >= '0' && text[*at] <= '9' && *at - begin < most)
    *digits = 10 * *digits + (text[(*at)++] - '0');
  return *at - begin;
}

}  // namespace internal

// The number with which `text` begins, where it is written plainly ("-12.25": digits, perhaps a point and digits) and
// short enough that double arithmetic gives the very value of ParseDouble; its length goes to `length`. Else nothing:
// then ParseDouble decides.
inline std::optional<double> ParsePlainDecimal(std::string_view text, std::size_t* length, char decimal_mark = '.') {
  // A whole number below 2^53 and a power of ten up to 10^22 are doubles, so that one division rounds once.
  constexpr std::size_t kMostDigits = 15;
  static constexpr std::array<double, kMostDigits + 1> kPowers = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                                  1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  std::size_t at = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) ++at;
  std::int64_t digits = 0;
  // One more than allowed shows that there are too many.
  std::size_t count = internal::TakeDigits(text, kMostDigits + 1, &at, &digits), decimals = 0;
  if (count == 0 || count > kMostDigits) return std::nullopt;
  if (at < text.size() && text[at] == decimal_mark) {
    ++at;
    decimals = internal::TakeDigits(text, kMostDigits + 1 - count, &at, &digits);
    count += decimals;
    if (decimals == 0 || count > kMostDigits) return std::nullopt;
  }
  *length = at;
  const double value = static_cast<double>(digits) / kPowers[decimals];
  return negative ? -value : value;
}

}  // namespace lobefit
