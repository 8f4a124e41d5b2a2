// Where a reader stands in its file: messages with the place, words of text formats, counts checked against the file.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/format.h"
#include "lobefit/math/vec.h"

namespace lobefit {

// InputError "FILE: line N: MESSAGE" and "FILE: byte N: MESSAGE".
[[noreturn]] void FailAtLine(const InputFile& file, std::size_t line, const std::string& message);
[[noreturn]] void FailAtByte(const InputFile& file, std::size_t byte, const std::string& message);

// Line of the byte at `offset`, from 1.
std::size_t LineOfByte(std::string_view bytes, std::size_t offset);

// The product of counts that a file states; nothing where it overflows.
std::optional<std::size_t> CheckedProduct(std::initializer_list<std::size_t> factors);

// The number that fills `field`; fails at `line` where it is not a number or, for FiniteNumber, not finite. `what`
// names the field in the message ("theta_i").
double NumberAt(const InputFile& file, std::size_t line, std::string_view field, const std::string& what);
double FiniteNumberAt(const InputFile& file, std::size_t line, std::string_view field, const std::string& what);

// Whether a unit direction counts as above the surface: the threshold of MeasurementBuilder::Add. For readers that tell
// a hole above the horizon from a cell below it.
inline bool IsAboveHorizon(const Vec3& unit_direction) { return unit_direction.z > 1e-9; }

// Scales positive factors so that their mean is 1; does nothing to an empty array.
void ScaleToMeanOne(std::vector<double>* factors);

// The beginning of a file, on which text formats are recognised: the same answer whether or not a large file is cut
// off.
std::string_view Head(std::string_view bytes);

// True for a line of `text` whose first word is `word`.
bool HasLineWithFirstWord(std::string_view text, std::string_view word);

// Walks over the words of a text file, across line ends; lines that begin with a comment mark are left out.
class WordReader {
 public:
  explicit WordReader(const InputFile& file, std::string_view comment_mark = "#")
      : file_(file), comment_mark_(comment_mark), lines_(file.bytes) {}

  // The next word, nothing at the end of the file. Peek does not go past it.
  std::optional<std::string_view> Next();
  std::optional<std::string_view> Peek();
  // What remains of the line of the word that Next gave last.
  std::string_view RestOfLine();

  // The next word as what it has to be; `what` names it in the message. Number may be infinite or not a number.
  std::string_view Word(const std::string& what);
  double Number(const std::string& what);
  double FiniteNumber(const std::string& what);
  // A count of at least 1 of things that follow in the file, each at least a character and a separator.
  std::size_t Count(const std::string& what);
  // A count and as many finite numbers in [low, high].
  std::vector<double> List(const std::string& what, double low, double high);
  // Fails unless `words` words of values can still follow; nothing stands for an overflow.
  void ExpectRoomFor(std::optional<std::size_t> words, const std::string& what) const;

  // Line of the word that Next gave last.
  std::size_t line() const { return line_; }
  [[noreturn]] void Fail(const std::string& message) const;

 private:
  std::size_t MostWordsLeft() const;

  const InputFile& file_;
  std::string_view comment_mark_;
  LineReader lines_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace lobefit
