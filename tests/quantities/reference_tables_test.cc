// All 40 reference tables through the table of quantities that `lobefit eval` uses. LOBEFIT_REFERENCE_TABLES=FOLDER
// runs the same comparison on tables of another seed.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/support/reference_table.h"
#include <gtest/gtest.h>

#include "lobefit/quantities/quantities.h"

namespace lobefit {
namespace {

const std::set<std::string> kTables = {"aperture_ggx",
                                       "asinh_residual",
                                       "brdf",
                                       "coat_brdf",
                                       "diffuse_eon",
                                       "diffuse_interfaced",
                                       "ellipsoid_D",
                                       "ellipsoid_G1",
                                       "ellipsoid_from_offcenter",
                                       "fresnel",
                                       "fresnel_curve",
                                       "fresnel_f82",
                                       "g2",
                                       "gain_profile",
                                       "lune_area",
                                       "misaligned_brdf",
                                       "offcenter_D",
                                       "offcenter_from_ellipsoid",
                                       "profile_D",
                                       "profile_brdf",
                                       "profile_radial",
                                       "profile_sigma",
                                       "retro_brdf",
                                       "sel",
                                       "sel_integral",
                                       "sigma_beckmann",
                                       "sigma_ggx",
                                       "sigma_kk",
                                       "sigma_ring",
                                       "sigma_sg",
                                       "smith_lambda",
                                       "ssl",
                                       "student_D",
                                       "student_sigma",
                                       "triangle_ggx",
                                       "truncated_radius",
                                       "vcavity",
                                       "vndf_moments",
                                       "vndf_pdf",
                                       "white_furnace"};

bool IsMeta(const std::string& column) { return column.starts_with("cond") || column == "quad_err"; }

// The function that a derivative column is of; empty for values.
std::string DerivedFrom(const std::string& column) {
  const std::size_t at = column.rfind("_d");
  return column[0] == 'd' && at != std::string::npos ? column.substr(1, at - 1) : "";
}

// Accepted errors of a row: a value's is relative * |value| + absolute, a derivative's is derivative * (largest of its
// function in the row) + derivative_absolute.
struct Tolerance {
  double relative, absolute, derivative, derivative_absolute;
};

Tolerance ToleranceOf(const ReferenceTable& table, const std::string& name, std::size_t row,
                      const std::string& column) {
  Tolerance t{1e-12, 0, 1e-9, 0};
  if (name == "sigma_sg") t = {0, 1e-14, 1e-9, 0};
  if (name == "white_furnace" || name == "vndf_moments" || name == "ellipsoid_from_offcenter") t.relative = 1e-9;
  if (name == "aperture_ggx") t.relative = 1e-10;
  if (name == "triangle_ggx") t.relative = t.derivative = 1e-8;
  // Their S and Lambda were computed with 40 digits and differenced: what is smaller than that is not in them.
  if (name.starts_with("profile_")) t.absolute = t.derivative_absolute = 1e-36;
  if (name == "student_sigma") t = {1e-12, 1e-45, 1e-9, 1e-36};
  const std::string function = DerivedFrom(column).empty() ? column : DerivedFrom(column);
  const std::string layered = function == "f_layered" || function == "base_unrefracted" ? "layered" : "refracted";
  for (const std::string& cond :
       {"cond_" + function, std::string("cond_sigma"), "cond_" + layered, std::string("cond")}) {
    if (name == "triangle_ggx" || !table.Has(cond)) continue;
    const double amplification = std::fmax(1, table(row, cond));  // 1 where it is nan, on kinks
    // Student's sigma is an integral, of 256 points a panel.
    t.relative = (name == "student_sigma" ? 1e-12 : 64 * std::numeric_limits<double>::epsilon()) * amplification;
    t.derivative = 1e-9 * amplification;
    break;
  }
  return t;
}

double InputOf(const InputColumn& column, const std::string& text) {
  if (column.words.empty()) return ParseDouble(text).value();
  const auto word = std::find(column.words.begin(), column.words.end(), text);
  EXPECT_NE(word, column.words.end()) << text;
  return static_cast<double>(word - column.words.begin());
}

class ReferenceTables : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceTables, ValuesAndDerivatives) {
  const std::string& name = GetParam();
  const Quantity* quantity = FindQuantity(name);
  ASSERT_NE(quantity, nullptr);
  const ReferenceTable table(name);
  std::vector<double> inputs(quantity->inputs.size()), results(quantity->results.size());
  for (std::size_t row = 0; row < table.size(); ++row) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      inputs[i] = InputOf(quantity->inputs[i], table.Text(row, quantity->inputs[i].name));
    }
    const std::optional<DomainError> error = CheckDomain(*quantity, inputs.data());
    ASSERT_FALSE(error.has_value()) << "row " << row << ": " << error->message;
    quantity->evaluate(inputs.data(), results.data());
    std::map<std::string, double> largest;
    for (const ResultColumn& column : quantity->results) {
      const double expected = std::abs(table(row, column.name));
      double& of_function = largest[DerivedFrom(column.name)];
      if (expected > of_function) of_function = expected;
    }
    for (std::size_t k = 0; k < results.size(); ++k) {
      const std::string& column = quantity->results[k].name;
      const double expected = table(row, column);
      EXPECT_EQ(std::isnan(results[k]), std::isnan(expected)) << column << ", row " << row;
      if (std::isnan(expected)) continue;
      const Tolerance t = ToleranceOf(table, name, row, column);
      const std::string function = DerivedFrom(column);
      const double accepted = quantity->results[k].is_flag ? 0
                              : function.empty()           ? t.relative * std::abs(expected) + t.absolute
                                                           : t.derivative * largest[function] + t.derivative_absolute;
      EXPECT_LE(std::abs(results[k] - expected), accepted)
          << column << ", row " << row << ": " << results[k] << " instead of " << expected;
    }
  }
}

TEST_P(ReferenceTables, HaveTheSameColumns) {
  const Quantity* quantity = FindQuantity(GetParam());
  ASSERT_NE(quantity, nullptr);
  const ReferenceTable table(GetParam());
  std::vector<std::string> columns, expected;
  for (const InputColumn& column : quantity->inputs) columns.push_back(column.name);
  for (const ResultColumn& column : quantity->results) columns.push_back(column.name);
  for (const std::string& column : table.columns()) {
    if (!IsMeta(column)) expected.push_back(column);
  }
  EXPECT_EQ(columns, expected);
}

INSTANTIATE_TEST_SUITE_P(All, ReferenceTables, testing::ValuesIn(kTables), [](const auto& test) { return test.param; });

TEST(Quantities, AreThoseOfTheTables) {
  std::set<std::string> names;
  for (const Quantity& quantity : Quantities()) names.insert(quantity.name);
  EXPECT_EQ(names, kTables);
  EXPECT_EQ(Quantities().size(), 40U);
  EXPECT_EQ(FindQuantity("ellipsoid_d"), nullptr);
}

TEST(Quantities, AreDescribed) {
  for (const Quantity& quantity : Quantities()) {
    EXPECT_FALSE(quantity.description.empty()) << quantity.name;
    EXPECT_EQ(quantity.source.empty(), false) << quantity.name;
    for (const InputColumn& column : quantity.inputs) {
      EXPECT_FALSE(column.unit.empty() || column.meaning.empty()) << quantity.name << " " << column.name;
    }
    for (const ResultColumn& column : quantity.results) {
      EXPECT_FALSE(column.unit.empty()) << quantity.name << " " << column.name;
      EXPECT_EQ(column.meaning.empty(), !DerivedFrom(column.name).empty()) << quantity.name << " " << column.name;
    }
  }
}

TEST(Quantities, UnitsOfDerivativesFollow) {
  const Quantity& d = *FindQuantity("ellipsoid_D");
  EXPECT_EQ(d.results[1].unit, "1/sr");      // by alpha_x
  EXPECT_EQ(d.results[3].unit, "1/sr/rad");  // by theta_x
  const Quantity& e = *FindQuantity("ellipsoid_from_offcenter");
  EXPECT_EQ(e.results[2].unit, "rad");
  EXPECT_EQ(e.results[15].unit, "rad");  // theta_x by slope_x
}

TEST(Quantities, DomainsAreChecked) {
  const Quantity& d = *FindQuantity("ellipsoid_D");
  std::vector<double> in = {0.1, 0.2, 0, 0, 0, 0, 0, 1};
  EXPECT_FALSE(CheckDomain(d, in.data()).has_value());
  const auto column_refused = [&](std::size_t column, double value) {
    std::vector<double> changed = in;
    changed[column] = value;
    const std::optional<DomainError> error = CheckDomain(d, changed.data());
    return error.has_value() ? static_cast<int>(error->column) : -1;
  };
  EXPECT_EQ(column_refused(0, 0), 0);
  EXPECT_EQ(column_refused(1, -0.1), 1);
  EXPECT_EQ(column_refused(2, NAN), 2);
  EXPECT_EQ(column_refused(6, INFINITY), 6);
  EXPECT_EQ(column_refused(7, 0), 5);  // no direction is left
  EXPECT_EQ(column_refused(7, -1), -1);
  EXPECT_EQ(DomainText(d.inputs[0]), "> 0");
  EXPECT_EQ(DomainText(FindQuantity("ssl")->inputs[0]), "in (0, 1]");
  EXPECT_EQ(DomainText(FindQuantity("g2")->inputs[0]), "one of beckmann, ggx");
  const double radii[] = {0.1, 2, 1, 0.5};
  EXPECT_EQ(CheckDomain(*FindQuantity("truncated_radius"), radii)->column, 2U);
  const double behind[] = {1, 0.1, 0.1, 0, 2, 0, 0, 0, 1, 0.9, 0, 0.1};
  EXPECT_EQ(CheckDomain(*FindQuantity("g2"), behind)->column, 11U);
}

TEST(Quantities, ModelsWithoutAMeanSlopeAreRefused) {
  const double profile[] = {0.1, 0.1, 0, 0, 0, 0, 0, 0, 0, 0, -0.5, 0, 0, 1};
  EXPECT_EQ(CheckDomain(*FindQuantity("profile_D"), profile)->column, 10U);
  const double student[] = {1.5, 0.1, 0.1, 0, 0, 0, 0, 0, 1};
  EXPECT_EQ(CheckDomain(*FindQuantity("student_sigma"), student)->column, 0U);
  const double pole[] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(CheckDomain(*FindQuantity("profile_radial"), pole)->column, 1U);
}

// A direction is normalised, so its length does not matter; 2 is exact.
TEST(Quantities, LengthOfADirectionDoesNotMatter) {
  const Quantity& q = *FindQuantity("smith_lambda");
  double in[] = {1, 0.1, 0.3, 0.2, 0.4, -0.1, 0.3, -0.2, 0.7};
  std::vector<double> one(q.results.size()), two(q.results.size());
  q.evaluate(in, one.data());
  for (int k = 6; k < 9; ++k) in[k] *= 2;
  q.evaluate(in, two.data());
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace lobefit
