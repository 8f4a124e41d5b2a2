#include "lobefit/io/csv/rows/row_polarisations.h"

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/measurement/prepare/polarisation.h"

namespace lobefit {

std::uint8_t RowPolarisations::NumberOf(const RowParser& row, const ValueGroup& group) {
  std::string word = group.polarisation;
  for (const std::size_t column : layout_.polarisations)
    word += (word.empty() ? "" : " ") + ToLower(Trim(row.Text(column)));
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (names_[i] == word) return static_cast<std::uint8_t>(i);
  }
  if (names_.empty() && !layout_.polarisations.empty()) first_ = std::string(Trim(row.Text(layout_.polarisations[0])));
  if (names_.size() >= 200) {
    throw InputError("line " + std::to_string(header_.names_line) +
                     ": the column of polarisations holds more than 200 different words; choose one with --where");
  }
  names_.push_back(word);
  return static_cast<std::uint8_t>(names_.size() - 1);
}

std::string RowPolarisations::Choice() const {
  if (layout_.polarisations.empty())
    return "--value-column " + Excerpt(header_.columns[layout_.groups[0].values[0]].name);
  return "--where " + Excerpt(header_.columns[layout_.polarisations[0]].name) + "=" + Excerpt(first_);
}

std::string RowPolarisations::Average(Measurement* measurement) const {
  if (of_samples_.empty()) return "";
  const std::string remark = AverageOverPolarisation(of_samples_, names_, measurement);
  return remark.empty() ? remark : remark + "; " + Choice() + " chooses one";
}

}  // namespace lobefit
