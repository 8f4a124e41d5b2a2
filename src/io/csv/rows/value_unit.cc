#include "lobefit/io/csv/rows/value_unit.h"

#include <algorithm>
#include <optional>

#include "lobefit/base/error.h"
#include "lobefit/base/text/text.h"
#include "lobefit/io/csv/head/value_mention.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

void FindScale(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
               const std::vector<CsvColumn>& columns, const CsvColumn& column, const ValueMention& mention,
               CsvLayout* layout, Measurement* notes) {
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
  } else if (mention.scale && mention.kind == layout->value_kind) {
    layout->value_scale = *mention.scale;
    unit = mention.line;
    origin = "title";
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
  if (options.value_scale.empty() && !layout->value_scale.arbitrary && !mention.arbitrary.empty()) {
    notes->remarks.push_back("a line says '" + Excerpt(mention.arbitrary, 60) +
                             "': where the scale of the values is not f_r in 1/sr, fit with --scale free");
  }
  const bool plain = layout->value_scale.IsIdentity() && !layout->value_scale.arbitrary;
  if (plain && options.value_scale.empty() && !header.keys.value_scale && !mention.multiple.empty()) {
    notes->remarks.push_back("a line says '" + Excerpt(mention.multiple, 60) +
                             "': the numbers are taken as the values; say with --value-scale, as 1e-3/sr, % or dB, "
                             "where they are a multiple of them or their logarithm");
  }
  if (plain) return;
  notes->conventions["value-scale"] = Excerpt(unit.empty() ? "as stated" : unit) + " (" + origin + ")";
  if (layout->value_scale.arbitrary) {
    notes->remarks.push_back("the values have no unit that is known (" + Excerpt(unit) +
                             "): their scale is not f_r in 1/sr; fit with --scale free");
  }
}

// By the names of its angles: SZA, "solar zenith".
bool IsOfSunlight(const std::vector<CsvColumn>& columns) {
  return std::any_of(columns.begin(), columns.end(), [](const CsvColumn& column) {
    const std::string name = ToLower(column.name);
    return column.role == ColumnRole::kCoordinate &&
           (name.find("sza") != std::string::npos || name.find("solar") != std::string::npos ||
            name.starts_with("sun"));
  });
}

// What no value-kind can cure.
void RemarkOnLight(const ValueMention& mention, Measurement* notes) {
  if (!mention.transmission.empty()) {
    notes->remarks.push_back("a line says '" + Excerpt(mention.transmission, 60) +
                             "': the values are read as those of reflected light, for which alone there are models");
  }
  if (!mention.polarised.empty()) {
    notes->remarks.push_back("a line says '" + Excerpt(mention.polarised, 60) +
                             "': the values are f_r of that light, not of unpolarised light");
  }
}

}  // namespace

void FindValueUnit(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                   const std::vector<CsvColumn>& columns, CsvLayout* layout, Measurement* notes) {
  const CsvColumn& column = columns[layout->groups[0].values[0]];
  const ValueMention mention = FindValueMention(header.titles);
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
  } else if (mention.kind) {
    layout->value_kind = *mention.kind;
    origin = "title";
    if (layout->value_kind != ValueKind::kBrdf) {
      notes->remarks.push_back("the values are taken as " + std::string(Name(layout->value_kind)) + ", as the line '" +
                               Excerpt(mention.line, 60) + "' says; --value-kind f reads them as f_r");
    }
  } else if (!mention.question.empty()) {
    notes->remarks.push_back(mention.question);
  } else if (column.role == ColumnRole::kChannel && IsOfSunlight(columns)) {
    notes->remarks.push_back(
        "the column " + QuotedName(column) +
        " does not say what its values are, they are taken as f_r; reflectance factors, as most of "
        "sunlight are (BRF, HDRF), are pi f_r: --value-kind pi-f");
  }
  RemarkOnLight(mention, notes);
  if (origin == "default" && column.fixed_incidence) {
    FailAtLine(file, header.names_line,
               "the column " + QuotedName(column) +
                   " does not say what its values are; instruments of this geometry give reflectance factors, often in "
                   "percent: --value-kind pi-f, and --value-scale % where they are");
  }
  const bool percent = column.value_scale && column.value_scale->factor == 0.01;
  if (origin == "default" && column.role == ColumnRole::kChannel && percent)
    FailAtLine(
        file, header.names_line,
        "the column " + QuotedName(column) + " in percent can be f_r or pi f_r; say it with --value-kind f|pi-f");
  notes->conventions["value-kind"] = std::string(Name(layout->value_kind)) + " (" + origin + ")";
  FindScale(file, header, options, columns, column, mention, layout, notes);
}

}  // namespace lobefit
