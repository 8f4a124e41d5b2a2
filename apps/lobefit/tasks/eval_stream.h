// Rows of CSV through a quantity: what `lobefit eval` does between its two streams.
#pragma once

#include <cstdio>

#include "lobefit/quantities/quantities.h"

namespace lobefit {

// Reads CSV with a header from `in` (LF or CRLF, last line end optional, fields may be quoted, no line breaks within
// fields) and writes the same rows to `out` with the quantity's results. Input columns are found by name, in any order;
// other columns pass through unchanged. A result column that is already there is replaced where it stands; the others
// are appended in the quantity's order. Numbers have 17 significant digits, flags are 0 or 1. One row is held at a
// time.
//
// Throws InputError, with line, row and column, for an empty stream, a missing or repeated column, a wrong number of
// fields, and a field that is no number, not finite or outside its domain; whole rows before it have then been written.
// Throws OutputError if `out` does not take the bytes.
void EvaluateStream(const Quantity& quantity, std::FILE* in, std::FILE* out);

}  // namespace lobefit
