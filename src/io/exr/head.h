// The attributes of an OpenEXR file, looked through before OpenEXR reserves memory for what they announce.
#pragma once

#include "lobefit/io/text/format.h"

namespace lobefit {

// Throws InputError, which names the byte, where an attribute or a string of a list claims more bytes than the file
// has, or where the file cannot hold the table of its tiles. What else is wrong with the head is left to OpenEXR.
// `file.bytes` may be the beginning of a file of `file_bytes`, as long as the head is in it. Heads of all parts.
void CheckExrHead(const InputFile& file, std::size_t file_bytes);

}  // namespace lobefit
