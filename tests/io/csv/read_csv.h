// Reads a text as a file of measurements, as the program does.
#pragma once

#include <string>
#include <string_view>

#include "tests/support/temporary_file.h"
#include <gtest/gtest.h>

#include "lobefit/base/error.h"
#include "lobefit/io/read.h"
#include "lobefit/math/directions.h"

namespace lobefit {

inline Measurement ReadText(std::string_view text, const ReadOptions& options = {}) {
  const TemporaryFile file(text);
  return ReadMeasurement(file.path(), options);
}

inline std::string MessageOf(std::string_view text, const ReadOptions& options = {}) {
  try {
    ReadText(text, options);
  } catch (const InputError& error) {
    return error.what();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "(was read)";
}

inline void ExpectDirection(const Vec3& found, double theta_deg, double phi_deg) {
  const Vec3 expected = FromSpherical(DegreesToRadians(theta_deg), DegreesToRadians(phi_deg));
  EXPECT_NEAR(Norm(found - expected), 0, 1e-12) << theta_deg << " " << phi_deg;
}

// The sample i is light from (theta_i, phi_i) seen from (theta_o, phi_o), degrees, with the value f.
inline void ExpectSample(const Measurement& m, std::size_t i, double theta_i, double phi_i, double theta_o,
                         double phi_o, double f) {
  ASSERT_LT(i, m.samples.size());
  ExpectDirection(m.samples.wi(i), theta_i, phi_i);
  ExpectDirection(m.samples.wo(i), theta_o, phi_o);
  EXPECT_NEAR(m.samples.values[0][i], f, 1e-12 * (1 + f));
}

inline bool HasRemark(const Measurement& m, std::string_view part) {
  for (const std::string& remark : m.remarks) {
    if (remark.find(part) != std::string::npos) return true;
  }
  return false;
}

}  // namespace lobefit
