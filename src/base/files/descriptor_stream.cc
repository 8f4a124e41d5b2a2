#include "lobefit/base/files/descriptor_stream.h"

#include <array>
#include <cerrno>
#include <cstring>
#include <streambuf>

#include <unistd.h>

#include "lobefit/base/error.h"
#include "lobefit/base/text/printable.h"

namespace lobefit {
namespace {

// Bytes to a descriptor that this class does not own.
class DescriptorBuffer : public std::streambuf {
 public:
  explicit DescriptorBuffer(int descriptor) : descriptor_(descriptor) { setp(buffer_.data(), buffer_.data() + kSize); }
  // Why writing failed; 0 where it did not.
  int reason() const { return reason_; }

 protected:
  int_type overflow(int_type c) override {
    if (!Send(buffer_.data(), pptr())) return traits_type::eof();
    setp(buffer_.data(), buffer_.data() + kSize);
    if (!traits_type::eq_int_type(c, traits_type::eof())) sputc(traits_type::to_char_type(c));
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    if (count < epptr() - pptr()) return std::streambuf::xsputn(bytes, count);
    if (sync() != 0 || !Send(bytes, bytes + count)) return 0;
    return count;
  }
  int sync() override { return traits_type::eq_int_type(overflow(traits_type::eof()), traits_type::eof()) ? -1 : 0; }

 private:
  static constexpr std::size_t kSize = 1 << 16;

  bool Send(const char* begin, const char* end) {
    while (begin != end && reason_ == 0) {
      const ssize_t count = write(descriptor_, begin, static_cast<std::size_t>(end - begin));
      if (count >= 0) begin += count;
      if (count < 0 && errno != EINTR) reason_ = errno;
    }
    return reason_ == 0;
  }

  int descriptor_, reason_ = 0;
  std::array<char, kSize> buffer_;
};

}  // namespace

void Fill(int descriptor, const std::filesystem::path& path, const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor);
  std::ostream out(&buffer);
  write(out);
  out.flush();
  if (!out) {
    throw OutputError(PrintableName(path) + ": writing failed: " + std::strerror(buffer.reason()) +
                      (buffer.reason() == ENOSPC || buffer.reason() == EDQUOT ? "; is the disk full?" : ""));
  }
}

}  // namespace lobefit
