#include "lobefit/io/csv/rows/row_uncertainty.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lobefit/base/text/text.h"
#include "lobefit/io/text/place.h"

namespace lobefit {

bool RowUncertainty::Find(const RowParser& row, const ValueGroup& group, std::size_t line, double factor,
                          double* weight) const {
  if (layout_.weight != kNoColumn) {
    *weight = row.Number(layout_.weight);
    if (*weight == 0) return false;
    if (!(*weight >= 1e-100 && *weight <= 1e100)) {
      FailAtLine(file_, line, "the weight is " + FormatDouble(*weight) + "; it must be 0, or 1e-100 to 1e100");
    }
    return true;
  }
  double variance = 0, count = 0;
  const auto add = [&](std::size_t column, std::size_t value_column) {
    const double number = row.Number(column);
    if (number < 0 || std::isinf(number)) {
      FailAtLine(file_, line,
                 "the standard deviation in column " + std::to_string(column + 1) + " is " + FormatDouble(number) +
                     "; it must be more than 0");
    }
    const double sigma = StandardDeviation(header_.columns[column], number, row.Number(value_column));
    if (!(sigma > 0)) return;  // 0 and no value: not known
    variance += sigma * sigma;
    ++count;
  };
  if (layout_.sigma != kNoColumn) add(layout_.sigma, group.values[0]);
  if (group.sigma != kNoColumn) add(group.sigma, group.values[0]);
  for (std::size_t c = 0; c < layout_.channel_sigmas.size(); ++c) add(layout_.channel_sigmas[c], group.values[c]);
  *weight = count > 0 ? factor * std::sqrt(variance / count) : std::nan("");
  return true;
}

// Of the value before the cosines, from what the column says about its numbers.
double RowUncertainty::StandardDeviation(const CsvColumn& column, double number, double value) const {
  number = (column.variance ? std::sqrt(number) : number) / column.coverage_factor;
  const bool percent = column.unit == "%" || column.unit == "percent";
  const double unit = percent ? 0.01 : column.unit == "ppm" ? 1e-6 : 1;
  const bool in_units_of_value =
      percent && layout_.value_scale.factor == 0.01 && ToLower(column.name).find("rel") == std::string::npos;
  if (column.relative && !in_units_of_value) return unit * number * std::fabs(layout_.value_scale.Apply(value));
  const std::optional<ValueScale> own =
      column.unit.empty() || in_units_of_value ? std::nullopt : ParseValueScale(column.unit);
  // Decibels are a ratio, whatever the values are in.
  if (own && own->form != ValueScale::Form::kLinear) {
    const double brdf = layout_.value_scale.Apply(value);
    return std::fabs(brdf) * own->Slope(0) * number;
  }
  if (own && own->form == ValueScale::Form::kLinear && layout_.value_scale.form == ValueScale::Form::kLinear)
    return own->factor * number;
  return std::fabs(layout_.value_scale.Slope(value)) * number;
}

void FillUnknown(std::vector<double>* sigma, std::vector<std::string>* remarks) {
  if (std::none_of(sigma->begin(), sigma->end(), [](double s) { return std::isnan(s); })) return;
  std::vector<double> known;
  for (const double s : *sigma) {
    if (!std::isnan(s)) known.push_back(s);
  }
  remarks->push_back(std::to_string(sigma->size() - known.size()) + " samples have no uncertainty" +
                     (known.empty() ? "; none was used" : "; the median of the others stands for it"));
  if (known.empty()) {
    sigma->clear();
    return;
  }
  std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2), known.end());
  for (double& s : *sigma) {
    if (std::isnan(s)) s = known[known.size() / 2];
  }
}

}  // namespace lobefit
