// The attributes of an OpenEXR file, looked through before OpenEXR reserves memory for what they announce.
#pragma once

#include "lobefit/io/text/format.h"

namespace lobefit {

// Throws InputError, which names the byte, where an attribute or a string of a list claims more bytes than the file
// has, or where the file cannot hold the table of its tiles. What else is wrong with the head is left to OpenEXR.
void CheckExrHead(const InputFile& file);

}  // namespace lobefit
