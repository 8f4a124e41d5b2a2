#include "lobefit/io/text/encodings.h"

#include <array>
#include <cerrno>
#include <cstddef>

#include <iconv.h>

namespace lobefit {
namespace {

struct Encoding {
  const char* name;
  // Of two signs and more: by chance they do not come out of another encoding.
  std::array<std::string_view, 8> words;
};

constexpr std::array<Encoding, 6> kEncodings = {{
    {"GB18030", {"入射", "反射", "散射", "角度", "方位", "波长", "测量", "观测"}},
    {"SHIFT_JIS", {"入射", "反射", "散乱", "角度", "方位", "波長", "測定", "受光"}},
    {"BIG5", {"入射", "反射", "散射", "角度", "方位", "波長", "量測", "觀測"}},
    {"EUC-KR", {"입사", "반사", "산란", "각도", "방위", "파장", "측정", "수광"}},
    {"WINDOWS-1250", {"kąt", "Kąt", "pomiar", "świat", "úhel", "Úhel", "měřen", "světl"}},
    {"WINDOWS-1251", {"угол", "угл", "паден", "отраж", "азимут", "зенит", "длина", "рассея"}},
}};

}  // namespace

std::string ConvertLoosely(std::string_view text, const char* encoding) {
  const iconv_t converter = iconv_open("UTF-8//IGNORE", encoding);
  if (converter == reinterpret_cast<iconv_t>(-1)) return "";
  std::string converted(3 * text.size() + 16, '\0');
  // iconv does not write to its input, but its interface was made before const.
  char* in = const_cast<char*>(text.data());
  char* out = converted.data();
  std::size_t left = text.size(), room = converted.size();
  while (left > 0) {
    const std::size_t result = iconv(converter, &in, &left, &out, &room);
    if (result != static_cast<std::size_t>(-1) || errno == E2BIG || left == 0) break;
    // A byte that is none of the encoding's.
    ++in;
    --left;
  }
  iconv_close(converter);
  converted.resize(converted.size() - room);
  return converted;
}

const char* FindEncoding(std::string_view text) {
  const char* best = "WINDOWS-1252";
  std::size_t most = 0;
  for (const Encoding& encoding : kEncodings) {
    const std::string converted = ConvertLoosely(text, encoding.name);
    std::size_t found = 0;
    for (const std::string_view word : encoding.words) found += converted.find(word) != std::string::npos ? 1 : 0;
    if (found <= most) continue;
    most = found;
    best = encoding.name;
  }
  return best;
}

}  // namespace lobefit
