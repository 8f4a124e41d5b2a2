#include "lobefit/io/rgl/tensor_file.h"

#include <cstring>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"

namespace lobefit {
namespace {

std::string Write(const std::vector<TensorOutput>& fields) {
  std::ostringstream out;
  WriteTensorFile(out, fields);
  return out.str();
}

std::string_view Raw(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

TEST(TensorFile, ReadsBackWhatItWrites) {
  const std::vector<float> a = {1, 2, 3, 4, 5, 6};
  const std::string bytes =
      Write({{"text", TensorType::kUint8, {5}, "hello"}, {"a", TensorType::kFloat32, {2, 3}, Raw(a)}});
  EXPECT_EQ(bytes.size() % 8, 0U);
  const TensorFile file("x", bytes);
  EXPECT_EQ(file.GetFloats("a", 2), a);
  EXPECT_EQ(file.Get("text", TensorType::kUint8, 1).bytes, "hello");
  EXPECT_EQ(file.Get("a", TensorType::kFloat32, 2).ShapeText(), "[2, 3]");
  EXPECT_EQ((file.Get("a", TensorType::kFloat32, 2).bytes.data() - bytes.data()) % 8, 0);
  EXPECT_FALSE(file.Has("b"));
}

TEST(TensorFile, RefusesMissingFieldsWrongTypesAndNumbersThatAreNotFinite) {
  const std::vector<float> a = {1, std::numeric_limits<float>::infinity()};
  const std::string bytes = Write({{"a", TensorType::kFloat32, {2}, Raw(a)}});
  const TensorFile file("x", bytes);
  EXPECT_THROW(file.Get("b", TensorType::kFloat32, 1), InputError);
  EXPECT_THROW(file.Get("a", TensorType::kFloat64, 1), InputError);
  EXPECT_THROW(file.Get("a", TensorType::kFloat32, 2), InputError);
  EXPECT_THROW(file.GetFiniteFloats("a", 1), InputError);
}

// Every cut and every changed byte of the head is either refused or read within the bounds of the file (checked by the
// sanitizers).
TEST(TensorFile, SurvivesEveryCutAndEveryChangedByte) {
  const std::vector<float> a = {1, 2, 3, 4};
  const std::string bytes =
      Write({{"a", TensorType::kFloat32, {2, 2}, Raw(a)}, {"bb", TensorType::kUint8, {3}, "xyz"}});
  std::size_t refused = 0;
  const auto try_reading = [&](std::string_view changed) {
    try {
      const TensorFile file("x", changed);
      if (file.Has("a")) file.GetFloats("a", 2);
    } catch (const InputError&) {
      ++refused;
    }
  };
  for (std::size_t length = 0; length < bytes.size(); ++length) try_reading(std::string_view(bytes).substr(0, length));
  EXPECT_GE(refused, bytes.size() - 8);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const char value : {'\0', '\1', '\x7f', '\xff'}) {
      std::string changed = bytes;
      changed[at] = value;
      try_reading(changed);
    }
  }
}

}  // namespace
}  // namespace lobefit
