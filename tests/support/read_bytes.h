// Readers called on bytes in memory, and what they throw.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"

namespace lobefit {

using Reader = Measurement (*)(const InputFile&, const ReadOptions&);

inline Measurement ReadBytes(Reader reader, std::string_view bytes, const ReadOptions& options = {}) {
  return reader(InputFile{"file", bytes}, options);
}

// The message without the file's name; "(was read)" where nothing was thrown.
inline std::string ErrorOf(Reader reader, std::string_view bytes, const ReadOptions& options = {}) {
  try {
    ReadBytes(reader, bytes, options);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with("file: ")) << message;
    return message.substr(std::min<std::size_t>(6, message.size()));
  }
  return "(was read)";
}

// Compares with a direction given by its components or by polar angle and azimuth in degrees.
inline void ExpectVector(const Vec3& found, const Vec3& expected, double tolerance = 1e-14) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
  EXPECT_NEAR(found.z, expected.z, tolerance);
}
inline void ExpectAngles(const Vec3& found, double theta_deg, double phi_deg, double tolerance = 1e-14) {
  SCOPED_TRACE(std::to_string(theta_deg) + " " + std::to_string(phi_deg));
  const double sine = std::sin(DegreesToRadians(theta_deg));
  ExpectVector(found,
               {sine * std::cos(DegreesToRadians(phi_deg)), sine * std::sin(DegreesToRadians(phi_deg)),
                std::cos(DegreesToRadians(theta_deg))},
               tolerance);
}

}  // namespace lobefit
