// What instruments and spreadsheets write where there is no value.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lobefit {

// "OVER", "-", "#N/A", "1.#QNAN", "<0.001", the empty field and their like; case does not matter.
bool IsNoValueWord(std::string_view field);

// --no-value LIST: words and numbers that stand for no value, separated by commas.
class NoValues {
 public:
  NoValues() = default;
  // Throws UsageError for an empty item.
  explicit NoValues(const std::string& list);
  bool empty() const { return words_.empty() && numbers_.empty(); }
  bool Holds(double number) const;
  bool Holds(std::string_view word) const;
  const std::vector<double>& numbers() const { return numbers_; }

 private:
  std::vector<std::string> words_;
  std::vector<double> numbers_;
};

}  // namespace lobefit
