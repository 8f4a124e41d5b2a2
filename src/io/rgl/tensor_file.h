// The tensor container of the RGL material database: named n-dimensional arrays behind a table of descriptors.
//   "tensor_file\0", u8 1, u8 0, u32 fields; a field: u16 name length, name, u16 ndim, u8 type, u64 offset from the
//   file's start, ndim x u64 shape; data little endian, last index fastest.
#pragma once

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

enum class TensorType : std::uint8_t {
  kUint8 = 1,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat16,
  kFloat32,
  kFloat64
};

// "float32", "uint8", ...
std::string_view Name(TensorType type);

struct TensorField {
  TensorType type;
  std::vector<std::uint64_t> shape;
  // Number of elements and the elements' bytes, which lie in the file.
  std::uint64_t count;
  std::string_view bytes;

  // "[16, 8, 32, 32]".
  std::string ShapeText() const;
};

// A parsed container. The bytes that the constructor was given must outlive it.
class TensorFile {
 public:
  // True where the bytes begin with the container's magic.
  static bool HasMagic(std::string_view bytes);

  // Checks every descriptor against the file before anything is allocated. Throws InputError with the byte.
  TensorFile(const std::filesystem::path& path, std::string_view bytes);

  bool Has(const std::string& name) const { return fields_.contains(name); }
  // The field `name` with its type and number of dimensions checked. Throws InputError that lists the fields of the
  // file.
  const TensorField& Get(const std::string& name, TensorType type, std::size_t ndim) const;
  // A copy of a float32 field. GetFiniteFloats: every element must be finite (InputError with the index otherwise).
  std::vector<float> GetFloats(const std::string& name, std::size_t ndim) const;
  std::vector<float> GetFiniteFloats(const std::string& name, std::size_t ndim) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::map<std::string, TensorField> fields_;
};

// One field to be written. `bytes` are the elements in C order.
struct TensorOutput {
  std::string name;
  TensorType type;
  std::vector<std::uint64_t> shape;
  std::string_view bytes;
};

// Writes a container of version 1.0; each block of data starts at a multiple of 8 bytes, as readers that map the file
// expect.
void WriteTensorFile(std::ostream& out, std::span<const TensorOutput> fields);

}  // namespace lobefit
