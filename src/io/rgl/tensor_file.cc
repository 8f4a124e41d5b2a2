#include "lobefit/io/rgl/tensor_file.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <ostream>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"

namespace lobefit {
namespace {

constexpr std::string_view kMagic("tensor_file\0", 12);
constexpr std::size_t kHeaderBytes = 18;
// Name length, number of dimensions, type and offset: the least that a descriptor takes.
constexpr std::size_t kLeastDescriptorBytes = 2 + 2 + 1 + 8;
constexpr std::size_t kMostDimensions = 16;

struct TypeInfo {
  std::string_view name;
  std::size_t bytes;
};
constexpr std::array<TypeInfo, 11> kTypes = {{{"uint8", 1},
                                              {"int8", 1},
                                              {"uint16", 2},
                                              {"int16", 2},
                                              {"uint32", 4},
                                              {"int32", 4},
                                              {"uint64", 8},
                                              {"int64", 8},
                                              {"float16", 2},
                                              {"float32", 4},
                                              {"float64", 8}}};

const TypeInfo& InfoOf(TensorType type) { return kTypes[static_cast<std::size_t>(type) - 1]; }

// Reads little-endian numbers one after the other and knows where it is.
class Cursor {
 public:
  Cursor(const std::filesystem::path& path, std::string_view bytes, std::size_t at)
      : path_(path), bytes_(bytes), at_(at) {}

  std::size_t at() const { return at_; }

  std::string_view Take(std::size_t count, const std::string& what) {
    if (count > bytes_.size() - at_) {
      Fail(at_, what + " (" + std::to_string(count) + " bytes) is cut off: the file ends at byte " +
                    std::to_string(bytes_.size()) + "; fetch the file again");
    }
    const std::string_view taken = bytes_.substr(at_, count);
    at_ += count;
    return taken;
  }

  template <class T>
  T Number(const std::string& what) {
    T value = 0;
    std::memcpy(&value, Take(sizeof(T), what).data(), sizeof(T));
    return value;
  }

  [[noreturn]] void Fail(std::size_t at, const std::string& what) const {
    throw InputError(path_.string() + ": byte " + std::to_string(at) + ": " + what);
  }

 private:
  const std::filesystem::path& path_;
  std::string_view bytes_;
  std::size_t at_;
};

TensorField ReadDescriptor(Cursor* cursor, std::string_view bytes, const std::string& name) {
  const std::size_t at = cursor->at();
  const std::string label = "field '" + Excerpt(name) + "'";
  const auto ndim = cursor->Number<std::uint16_t>("the number of dimensions of " + label);
  if (ndim > kMostDimensions) {
    cursor->Fail(at, label + " has " + std::to_string(ndim) + " dimensions; at most " +
                         std::to_string(kMostDimensions) + " are allowed");
  }
  const auto type = cursor->Number<std::uint8_t>("the type of " + label);
  if (type < 1 || type > kTypes.size()) {
    cursor->Fail(at + 2, label + " has type " + std::to_string(type) + "; allowed are 1 to 11 (10 is float32)");
  }
  const auto offset = cursor->Number<std::uint64_t>("the offset of " + label);
  TensorField field = {static_cast<TensorType>(type), {}, 1, {}};
  const std::uint64_t element = InfoOf(field.type).bytes;
  for (std::uint16_t d = 0; d < ndim; ++d) {
    const auto extent = cursor->Number<std::uint64_t>("the shape of " + label);
    field.shape.push_back(extent);
    // The product stays below the file's size, so it cannot overflow.
    if (extent != 0 && field.count > bytes.size() / element / extent) {
      cursor->Fail(at, label + " of type " + std::string(Name(field.type)) + " and shape " + field.ShapeText() +
                           (d + 1 < ndim ? " ..." : "") + " needs more bytes than the file has (" +
                           std::to_string(bytes.size()) + ")");
    }
    field.count *= extent;
  }
  const std::uint64_t size = field.count * element;
  if (size > bytes.size() || offset > bytes.size() - size) {
    cursor->Fail(at, label + " claims the bytes " + std::to_string(offset) + " + " + std::to_string(size) +
                         ", but the file ends at byte " + std::to_string(bytes.size()) + "; fetch the file again");
  }
  field.bytes = bytes.substr(offset, size);
  return field;
}

template <class T>
void Put(std::ostream& out, T value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  out.write(raw.data(), raw.size());
}

std::uint64_t RoundUpTo8(std::uint64_t size) { return (size + 7) / 8 * 8; }

}  // namespace

std::string_view Name(TensorType type) { return InfoOf(type).name; }

std::string TensorField::ShapeText() const {
  std::vector<std::string> extents;
  for (const std::uint64_t extent : shape) extents.push_back(std::to_string(extent));
  std::string text = "[";
  text += Join(extents);
  return text += "]";
}

bool TensorFile::HasMagic(std::string_view bytes) { return bytes.starts_with(kMagic); }

TensorFile::TensorFile(const std::filesystem::path& path, std::string_view bytes) : path_(path) {
  Cursor cursor(path_, bytes, 0);
  if (cursor.Take(std::min(kMagic.size(), bytes.size()), "the magic") != kMagic) {
    cursor.Fail(0, "does not begin with 'tensor_file' and a zero byte");
  }
  const auto major = cursor.Number<std::uint8_t>("the version");
  const auto minor = cursor.Number<std::uint8_t>("the version");
  if (major != 1 || minor != 0) {
    cursor.Fail(12, "the version is " + std::to_string(major) + "." + std::to_string(minor) + "; only 1.0 is known");
  }
  const auto count = cursor.Number<std::uint32_t>("the number of fields");
  if (count > (bytes.size() - kHeaderBytes) / kLeastDescriptorBytes) {
    cursor.Fail(14, "the header announces " + std::to_string(count) + " fields, but the file has only " +
                        std::to_string(bytes.size()) + " bytes; fetch the file again");
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t at = cursor.at();
    const std::string label = "field " + std::to_string(i + 1) + " of " + std::to_string(count);
    const auto length = cursor.Number<std::uint16_t>("the name of " + label);
    const std::string name(cursor.Take(length, "the name of " + label));
    const TensorField field = ReadDescriptor(&cursor, bytes, name);
    if (!fields_.emplace(name, field).second) {
      cursor.Fail(at, "the field '" + Excerpt(name) + "' occurs twice");
    }
  }
}

const TensorField& TensorFile::Get(const std::string& name, TensorType type, std::size_t ndim) const {
  const auto found = fields_.find(name);
  if (found == fields_.end()) {
    std::vector<std::string> present;
    for (const auto& [key, unused] : fields_) present.push_back(Excerpt(key));
    throw InputError(path_.string() + ": has no field '" + name + "'; its fields are: " + Join(present));
  }
  const TensorField& field = found->second;
  if (field.type != type || field.shape.size() != ndim) {
    throw InputError(path_.string() + ": field '" + name + "' is " + std::string(Name(field.type)) + " of shape " +
                     field.ShapeText() + "; it must be " + std::string(Name(type)) + " with " + std::to_string(ndim) +
                     (ndim == 1 ? " dimension" : " dimensions"));
  }
  return field;
}

std::vector<float> TensorFile::GetFloats(const std::string& name, std::size_t ndim) const {
  const TensorField& field = Get(name, TensorType::kFloat32, ndim);
  std::vector<float> values(field.count);
  if (field.count > 0) std::memcpy(values.data(), field.bytes.data(), field.bytes.size());
  return values;
}

std::vector<float> TensorFile::GetFiniteFloats(const std::string& name, std::size_t ndim) const {
  std::vector<float> values = GetFloats(name, ndim);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw InputError(path_.string() + ": field '" + name + "': element " + std::to_string(i) + " is " +
                       FormatDouble(static_cast<double>(values[i])) + "; only finite numbers are allowed");
    }
  }
  return values;
}

void WriteTensorFile(std::ostream& out, std::span<const TensorOutput> fields) {
  std::uint64_t offset = kHeaderBytes;
  for (const TensorOutput& field : fields) offset += kLeastDescriptorBytes + field.name.size() + 8 * field.shape.size();
  std::uint64_t written = offset;
  offset = RoundUpTo8(offset);
  out.write(kMagic.data(), static_cast<std::streamsize>(kMagic.size()));
  Put<std::uint8_t>(out, 1);
  Put<std::uint8_t>(out, 0);
  Put(out, static_cast<std::uint32_t>(fields.size()));
  std::uint64_t at = offset;
  for (const TensorOutput& field : fields) {
    Put(out, static_cast<std::uint16_t>(field.name.size()));
    out << field.name;
    Put(out, static_cast<std::uint16_t>(field.shape.size()));
    Put(out, static_cast<std::uint8_t>(field.type));
    Put(out, at);
    for (const std::uint64_t extent : field.shape) Put(out, extent);
    at = RoundUpTo8(at + field.bytes.size());
  }
  for (const TensorOutput& field : fields) {
    for (; written < offset; ++written) out.put('\0');
    out.write(field.bytes.data(), static_cast<std::streamsize>(field.bytes.size()));
    written += field.bytes.size();
    offset = RoundUpTo8(written);
  }
  for (; written < offset; ++written) out.put('\0');
}

}  // namespace lobefit
