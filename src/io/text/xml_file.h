// A small, strict view of an XML file: no external entities (none is ever expanded), a limit on depth and on the number
// of elements, and the line of every element for messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "pugixml.hpp"

#include "lobefit/io/text/format.h"

namespace lobefit {

class XmlFile {
 public:
  // Throws InputError where the file is not well-formed, is deeper than 32 elements or has more than `most_elements`.
  explicit XmlFile(const InputFile& file, std::size_t most_elements = 1000000);

  // The value of an attribute with its entities (&amp; &lt; &gt; &quot; &apos; and numbers) replaced; elsewhere text
  // stands as in the file.
  static std::string Unescaped(const char* value);

  const InputFile& file() const { return file_; }
  pugi::xml_node root() const { return document_.document_element(); }

  // The only child of that name; fails where there is none or, for OnlyChild, more than one.
  pugi::xml_node FirstChild(pugi::xml_node parent, const char* name) const;
  pugi::xml_node OnlyChild(pugi::xml_node parent, const char* name) const;

  // The text of an element without blanks around it, as a piece of the file's bytes; empty where it has none. Fails for
  // text that comments or elements interrupt.
  std::string_view Text(pugi::xml_node element) const;

  std::size_t Line(pugi::xml_node element) const;
  // Line of a piece of the file's bytes.
  std::size_t Line(std::string_view piece) const;
  [[noreturn]] void Fail(pugi::xml_node element, const std::string& message) const;

 private:
  void CheckSize(std::size_t most_elements) const;
  void CheckDepth() const;
  std::size_t LineAt(std::size_t byte) const;

  const InputFile& file_;
  // [k]: line ends before byte k kBlock. Readers ask for the line of each of many elements.
  static constexpr std::size_t kBlock = 4096;
  std::vector<std::size_t> lines_before_;
  pugi::xml_document document_;
};

}  // namespace lobefit
