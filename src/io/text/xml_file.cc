#include "lobefit/io/text/xml_file.h"

#include <algorithm>
#include <cstring>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

constexpr int kMostDepth = 32;

// Text is left as it stands in the file (no entities, no line end conversion), so that a place in it is a place there.
constexpr unsigned int kParse = pugi::parse_minimal | pugi::parse_cdata;

}  // namespace

XmlFile::XmlFile(const InputFile& file, std::size_t most_elements) : file_(file) {
  CheckSize(most_elements);
  const pugi::xml_parse_result result =
      document_.load_buffer(file.bytes.data(), file.bytes.size(), kParse, pugi::encoding_utf8);
  if (!result) {
    const std::size_t at = result.offset < 0 ? 0 : static_cast<std::size_t>(result.offset);
    FailAtLine(
        file, LineOfByte(file.bytes, at),
        std::string("is not well-formed XML here: ") + result.description() + "; export or fetch the file again");
  }
  for (std::size_t begin = 0, lines = 0; begin < file.bytes.size(); begin += kBlock) {
    lines_before_.push_back(lines);
    const std::string_view block = file.bytes.substr(begin, kBlock);
    lines += static_cast<std::size_t>(std::count(block.begin(), block.end(), '\n'));
  }
  CheckDepth();
}

void XmlFile::CheckSize(std::size_t most_elements) const {
  if (const std::size_t zero = file_.bytes.find('\0'); zero != std::string_view::npos) {
    FailAtByte(file_, zero, "is 0, which XML in UTF-8 does not allow; save the file as UTF-8");
  }
  // Each element takes some 100 bytes of memory, many times the 4 bytes of "<a/>", and so does each attribute of 5.
  const auto count = [&](char c) {
    return static_cast<std::size_t>(std::count(file_.bytes.begin(), file_.bytes.end(), c));
  };
  if (count('<') > most_elements || count('=') > 2 * most_elements) {
    FailAtLine(file_, 1,
               "the file has more than " + std::to_string(most_elements) + " elements or " +
                   std::to_string(2 * most_elements) +
                   " attributes; real files have a few hundred, their numbers are text");
  }
}

std::string XmlFile::Unescaped(const char* value) {
  pugi::xml_document text;
  text.load_string((std::string("<a b=\"") + value + "\"/>").c_str(), pugi::parse_minimal | pugi::parse_escapes);
  return text.first_child().attribute("b").value();
}

void XmlFile::CheckDepth() const {
  pugi::xml_node node = document_.first_child();
  int depth = 1;
  while (node) {
    if (depth > kMostDepth) {
      Fail(node, "elements are nested deeper than " + std::to_string(kMostDepth) + "; a BSDF file has 8 levels");
    }
    if (const pugi::xml_node child = node.first_child()) {
      node = child;
      ++depth;
      continue;
    }
    while (node && !node.next_sibling()) {
      node = node.parent();
      --depth;
    }
    if (node) node = node.next_sibling();
  }
}

pugi::xml_node XmlFile::FirstChild(pugi::xml_node parent, const char* name) const {
  const pugi::xml_node child = parent.child(name);
  if (!child) Fail(parent, std::string("<") + parent.name() + "> has no <" + name + ">; it is needed here");
  return child;
}

pugi::xml_node XmlFile::OnlyChild(pugi::xml_node parent, const char* name) const {
  const pugi::xml_node child = FirstChild(parent, name);
  if (const pugi::xml_node second = child.next_sibling(name)) {
    Fail(second, std::string("<") + parent.name() + "> has a second <" + name + ">; one is allowed");
  }
  return child;
}

std::string_view XmlFile::Text(pugi::xml_node element) const {
  const pugi::xml_node text = element.first_child();
  if (!text) return {};
  if (text.next_sibling() || (text.type() != pugi::node_pcdata && text.type() != pugi::node_cdata)) {
    Fail(element, std::string("<") + element.name() + "> holds elements or comments where only text is allowed");
  }
  const std::ptrdiff_t offset = text.offset_debug();
  const std::size_t length = std::strlen(text.value());
  // A byte order mark is not part of the buffer that the offset counts in.
  const std::size_t mark = file_.bytes.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;
  return Trim(file_.bytes.substr(static_cast<std::size_t>(offset) + mark, length));
}

std::size_t XmlFile::LineAt(std::size_t byte) const {
  const std::size_t block = std::min(byte, file_.bytes.size() - 1) / kBlock;
  return lines_before_[block] + LineOfByte(file_.bytes.substr(block * kBlock), byte - block * kBlock);
}

std::size_t XmlFile::Line(pugi::xml_node element) const {
  return LineAt(static_cast<std::size_t>(std::max<std::ptrdiff_t>(element.offset_debug(), 0)));
}

std::size_t XmlFile::Line(std::string_view piece) const {
  return LineAt(static_cast<std::size_t>(piece.data() - file_.bytes.data()));
}

void XmlFile::Fail(pugi::xml_node element, const std::string& message) const {
  FailAtLine(file_, Line(element), message);
}

}  // namespace lobefit
