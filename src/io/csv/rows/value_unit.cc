#include "lobefit/io/csv/rows/value_unit.h"

#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

void FindScale(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
               const std::vector<CsvColumn>& columns, const CsvColumn& column, CsvLayout* layout, Measurement* notes) {
  std::string origin, unit;
  if (!options.value_scale.empty()) {
    const std::optional<ValueScale> scale = ParseValueScale(options.value_scale);
    if (!scale)
      throw UsageError("--value-scale " + Excerpt(options.value_scale) +
                       ": allowed are 1/sr, %, dB, log10, ln, a power of ten as in 1e-3/sr, a.u.");
    layout->value_scale = *scale;
    unit = options.value_scale;
    origin = "option";
  } else if (header.keys.value_scale) {
    layout->value_scale = *header.keys.value_scale;
    origin = "header";
  } else if (column.value_scale) {
    layout->value_scale = *column.value_scale;
    unit = column.unit.empty() ? column.name : column.unit;
    origin = "column name";
  }
  for (const ValueGroup& group : layout->groups) {
    for (const std::size_t i : group.values) {
      const ValueScale other = columns[i].value_scale.value_or(ValueScale{});
      const ValueScale first = column.value_scale.value_or(ValueScale{});
      if (other.form != first.form || other.factor != first.factor)
        FailAtLine(file, header.names_line,
                   "the columns " + QuotedName(column) + " and " + QuotedName(columns[i]) +
                       " have different units; give all values in one");
    }
  }
  if (layout->value_scale.IsIdentity() && !layout->value_scale.arbitrary) return;
  notes->conventions["value-scale"] = Excerpt(unit.empty() ? "as stated" : unit) + " (" + origin + ")";
  if (layout->value_scale.arbitrary) {
    notes->remarks.push_back("the values have no unit that is known (" + Excerpt(unit) +
                             "): their scale is not f_r in 1/sr; fit with --scale free");
  }
}

}  // namespace

void FindValueUnit(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                   const std::vector<CsvColumn>& columns, CsvLayout* layout, Measurement* notes) {
  const CsvColumn& column = columns[layout->groups[0].values[0]];
  std::string origin = "default";
  if (options.value_kind) {
    layout->value_kind = *options.value_kind;
    origin = "option";
  } else if (header.keys.value_kind) {
    layout->value_kind = *header.keys.value_kind;
    origin = "header";
  } else if (column.value_kind) {
    layout->value_kind = *column.value_kind;
    origin = "column name";
  }
  const bool percent = column.value_scale && column.value_scale->factor == 0.01;
  if (origin == "default" && column.role == ColumnRole::kChannel && percent)
    FailAtLine(
        file, header.names_line,
        "the column " + QuotedName(column) + " in percent can be f_r or pi f_r; say it with --value-kind f|pi-f");
  notes->conventions["value-kind"] = std::string(Name(layout->value_kind)) + " (" + origin + ")";
  FindScale(file, header, options, columns, column, layout, notes);
}

}  // namespace lobefit
