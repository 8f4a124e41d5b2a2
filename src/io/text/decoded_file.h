// A file's bytes as readers want them: unpacked, text as UTF-8 without a byte order mark, lines that end with LF.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/base/files/file.h"

namespace lobefit {

class DecodedFile {
 public:
  // Reads the file. gzip is unpacked; UTF-16 (with a byte order mark, or recognised by its zeros) becomes UTF-8, as
  // does text that is no UTF-8 and is then taken for Windows-1252; a lone CR ends a line, and zeros or a Ctrl-Z at the
  // end of a text are none of it. Other files stay as they are. Throws InputError for a file that cannot be read, is
  // damaged, or unpacks to more than 2 GiB.
  explicit DecodedFile(const std::filesystem::path& path);

  std::string_view bytes() const { return decoded_.empty() ? rest_ : std::string_view(decoded_); }
  // As they are in the file, for its digest.
  std::string_view stored() const { return file_.bytes(); }
  // What was done, for people: "unpacked from gzip".
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  void Unpack();
  void DecodeText();
  void TrimEnd();

  FileBytes file_;
  std::string decoded_;    // where the bytes had to be changed
  std::string_view rest_;  // else a part of the file
  std::vector<std::string> remarks_;
};

}  // namespace lobefit
