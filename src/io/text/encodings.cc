#include "lobefit/io/text/encodings.h"

#include <array>
#include <cerrno>
#include <cstddef>

#include <iconv.h>

#include "lobefit/base/error.h"

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

// By iconv of the C library: it is everywhere, and knows the encodings that are needed.
class Converter {
 public:
  explicit Converter(const char* from) : converter_(iconv_open("UTF-8", from)) {}
  Converter(const Converter&) = delete;
  Converter& operator=(const Converter&) = delete;
  ~Converter() {
    if (IsKnown()) iconv_close(converter_);
  }
  bool IsKnown() const { return converter_ != reinterpret_cast<iconv_t>(-1); }

  // Up to the first byte that is none of the encoding's; returns how many are left.
  std::size_t Convert(std::string_view bytes, std::string* text) {
    text->resize(bytes.size() * 3 / 2 + 16);
    // iconv does not write to its input, but its interface was made before const.
    char* in = const_cast<char*>(bytes.data());
    std::size_t left = bytes.size(), used = 0;
    while (left > 0) {
      char* out = text->data() + used;
      std::size_t room = text->size() - used;
      const std::size_t result = iconv(converter_, &in, &left, &out, &room);
      used = text->size() - room;
      if (result != static_cast<std::size_t>(-1) || errno != E2BIG) break;
      text->resize(2 * text->size());
    }
    text->resize(used);
    return left;
  }

 private:
  iconv_t converter_;
};

}  // namespace

std::string ToUtf8(std::string_view bytes, const char* encoding, const std::filesystem::path& path) {
  const std::string_view all = encoding;
  const std::string name(all.substr(0, all.find('/')));
  Converter converter(encoding);
  if (!converter.IsKnown())
    throw InputError(path.string() + ": is " + name + " text, which this system cannot convert; save it as UTF-8");
  std::string text;
  const std::size_t left = converter.Convert(bytes, &text);
  if (left > 0) {
    throw InputError(path.string() + ": byte " + std::to_string(bytes.size() - left) + ": is neither UTF-8 nor " +
                     name + " text; save it as UTF-8");
  }
  return text;
}

const char* FindEncoding(std::string_view head) {
  const char* best = "WINDOWS-1252";
  std::size_t most = 0;
  std::string text;
  for (const Encoding& encoding : kEncodings) {
    Converter converter(encoding.name);
    if (!converter.IsKnown()) continue;
    converter.Convert(head, &text);
    std::size_t found = 0;
    for (const std::string_view word : encoding.words) found += text.find(word) != std::string::npos ? 1 : 0;
    if (found <= most) continue;
    most = found;
    best = encoding.name;
  }
  return best;
}

}  // namespace lobefit
