#include "lobefit/io/csv/layout.h"

#include <algorithm>
#include <map>

#include "lobefit/base/text.h"
#include "lobefit/io/text/options.h"
#include "lobefit/io/text/place.h"

namespace lobefit {
namespace {

std::string Quoted(const CsvColumn& column) {
  std::string quoted = "'";
  quoted += Excerpt(column.name);
  return quoted += '\'';
}

// Turns the header into a layout, or says what is missing, unknown or ambiguous.
class LayoutBuilder {
 public:
  LayoutBuilder(const InputFile& file, const CsvHeader& header, const ReadOptions& options, Measurement* measurement)
      : file_(file), header_(header), options_(options), measurement_(measurement) {}

  CsvLayout Build() {
    FindAngles();
    if (options_.value_column) {
      ChooseValueColumn(*options_.value_column);
    } else {
      ChooseChannels();
    }
    FindUncertainties();
    CheckUnknownColumns();
    SetValueKind();
    layout_.is_read.assign(header_.columns.size(), false);
    for (const std::size_t column : {layout_.theta_i, layout_.phi_i, layout_.theta_o, layout_.phi_o, layout_.delta_phi,
                                     layout_.azimuth, layout_.wavelength, layout_.weight, layout_.sigma}) {
      if (column != kNoColumn) layout_.is_read[column] = true;
    }
    for (const std::size_t column : layout_.values) layout_.is_read[column] = true;
    for (const std::size_t column : layout_.channel_sigmas) layout_.is_read[column] = true;
    return layout_;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { FailAtLine(file_, header_.names_line, what); }

  std::size_t FindOnly(ColumnRole role) const {
    std::size_t found = kNoColumn;
    for (std::size_t i = 0; i < header_.columns.size(); ++i) {
      if (header_.columns[i].role != role) continue;
      if (found != kNoColumn) {
        Fail("the columns " + Quoted(header_.columns[found]) + " and " + Quoted(header_.columns[i]) +
             " mean the same; remove one of them");
      }
      found = i;
    }
    return found;
  }

  void FindAngles() {
    layout_.theta_i = FindOnly(ColumnRole::kThetaI);
    layout_.theta_o = FindOnly(ColumnRole::kThetaO);
    layout_.phi_i = FindOnly(ColumnRole::kPhiI);
    layout_.phi_o = FindOnly(ColumnRole::kPhiO);
    layout_.delta_phi = FindOnly(ColumnRole::kDeltaPhi);
    layout_.azimuth = FindOnly(ColumnRole::kAzimuth);
    layout_.wavelength = FindOnly(ColumnRole::kWavelength);
    if (layout_.theta_i == kNoColumn || layout_.theta_o == kNoColumn) {
      std::vector<std::string> names;
      for (const CsvColumn& column : header_.columns) names.push_back(Excerpt(column.name));
      Fail(std::string("no column holds the polar angle ") +
           (layout_.theta_i == kNoColumn ? "of the light (theta_i)" : "of the viewer (theta_o)") +
           "; the columns are " + Excerpt(Join(names), 200) + "; allowed: " + AllowedColumns());
    }
    if (layout_.phi_o != kNoColumn && layout_.delta_phi != kNoColumn) {
      Fail("both phi_o and dphi are given; remove one of them");
    }
    if (layout_.azimuth != kNoColumn &&
        (layout_.phi_o != kNoColumn || layout_.delta_phi != kNoColumn || layout_.phi_i != kNoColumn)) {
      Fail("both azimuth and phi columns are given; name them phi_i and phi_o");
    }
  }

  void ChooseValueColumn(const std::string& name) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < header_.columns.size(); ++i) {
      const CsvColumn& column = header_.columns[i];
      names.push_back(Excerpt(column.name));
      if (ToLower(column.name) != ToLower(Trim(name))) continue;
      layout_.values = {i};
      layout_.channels.names = {column.role == ColumnRole::kChannel ? column.channel : "Y"};
      if (column.wavelength_nm > 0) layout_.channels.wavelengths_nm = {column.wavelength_nm};
      chosen_ = i;
      measurement_->conventions["value-column"] = column.name + " (option)";
      return;
    }
    Fail("no column is named '" + Excerpt(name) + "', which --value-column asks for; the columns are " +
         Excerpt(Join(names), 200));
  }

  void ChooseChannels() {
    std::vector<std::size_t> mono, spectral;
    std::map<std::string, std::size_t> letters;
    for (std::size_t i = 0; i < header_.columns.size(); ++i) {
      const CsvColumn& column = header_.columns[i];
      if (column.role == ColumnRole::kValue) mono.push_back(i);
      if (column.role != ColumnRole::kChannel) continue;
      if (column.wavelength_nm > 0) {
        spectral.push_back(i);
      } else if (!letters.emplace(column.channel, i).second) {
        Fail("two columns are named " + Quoted(column) + "; remove one of them");
      }
    }
    std::vector<std::vector<std::size_t>> candidates;
    for (const std::size_t i : mono) candidates.push_back({i});
    const bool has_xyz = letters.contains("X") && letters.contains("Z");
    if (letters.contains("Y") && !has_xyz) candidates.push_back({letters["Y"]});
    for (const char* triple : {"RGB", "XYZ"}) {
      std::vector<std::size_t> found, missing;
      for (const char c : std::string_view(triple)) {
        if (letters.contains(std::string(1, c))) found.push_back(letters[std::string(1, c)]);
      }
      if (found.size() == 3) candidates.push_back(found);
      const bool lone_y = found.size() == 1 && letters.contains("Y") && triple[0] == 'X';
      if (!found.empty() && found.size() < 3 && !lone_y) {
        Fail("of the channels " + std::string(triple) + " only " + std::to_string(found.size()) +
             " are given; give all three, or choose one column with --value-column");
      }
    }
    if (!spectral.empty()) candidates.push_back(spectral);
    if (candidates.size() != 1) {
      std::vector<std::string> names;
      for (const std::vector<std::size_t>& candidate : candidates) {
        names.push_back(Excerpt(header_.columns[candidate[0]].name) + (candidate.size() > 1 ? "..." : ""));
      }
      if (candidates.empty()) {
        Fail("no column holds values; allowed: " + AllowedColumns() + "; or choose one with --value-column");
      }
      Fail("several columns can be the value: " + Excerpt(Join(names), 200) + "; choose one with --value-column");
    }
    layout_.values = candidates[0];
    for (const std::size_t i : layout_.values) {
      const CsvColumn& column = header_.columns[i];
      layout_.channels.names.push_back(column.role == ColumnRole::kChannel ? column.channel : "Y");
      if (column.wavelength_nm > 0) layout_.channels.wavelengths_nm.push_back(column.wavelength_nm);
    }
    if (layout_.values.size() == 1) measurement_->conventions["value-column"] = header_.columns[layout_.values[0]].name;
  }

  void FindUncertainties() {
    layout_.weight = FindOnly(ColumnRole::kWeight);
    std::map<std::string, std::size_t> by_channel;
    for (std::size_t i = 0; i < header_.columns.size(); ++i) {
      const CsvColumn& column = header_.columns[i];
      if (column.role == ColumnRole::kSigma && !by_channel.emplace(column.channel, i).second) {
        Fail("two columns are named " + Quoted(column) + "; remove one of them");
      }
    }
    if (by_channel.empty()) return;
    if (layout_.weight != kNoColumn) Fail("both weight and sigma columns are given; remove one of them");
    if (by_channel.contains("")) {
      layout_.sigma = by_channel[""];
      return;
    }
    for (const std::string& channel : layout_.channels.names) {
      if (!by_channel.contains(channel)) {
        Fail("channel " + channel + " has no column sigma_" + channel +
             ", but other channels have one; give all or none");
      }
      layout_.channel_sigmas.push_back(by_channel[channel]);
    }
  }

  void CheckUnknownColumns() {
    std::vector<std::string> ignored;
    for (std::size_t i = 0; i < header_.columns.size(); ++i) {
      const CsvColumn& column = header_.columns[i];
      if (column.role == ColumnRole::kUnknown && chosen_ == kNoColumn) {
        Fail("column " + std::to_string(i + 1) + " is named " + Quoted(column) + ", which is not known; allowed: " +
             AllowedColumns() + "; or choose the column of values with --value-column, then unknown ones are ignored");
      }
      const bool other_value = (column.role == ColumnRole::kValue || column.role == ColumnRole::kChannel) &&
                               std::find(layout_.values.begin(), layout_.values.end(), i) == layout_.values.end();
      if ((column.role == ColumnRole::kUnknown && i != chosen_) || column.role == ColumnRole::kIgnored ||
          (column.role == ColumnRole::kOtherValue && i != chosen_) || other_value) {
        ignored.push_back(Excerpt(column.name));
      }
    }
    if (ignored.size() > 8) {
      const std::string more = " and " + std::to_string(ignored.size() - 8) + " more";
      ignored.resize(8);
      ignored.back() += more;
    }
    if (!ignored.empty()) measurement_->remarks.push_back("columns not used: " + Join(ignored));
  }

  void SetValueKind() {
    const std::optional<ValueKind> by_name = header_.columns[layout_.values[0]].value_kind;
    std::string origin = "default";
    layout_.value_kind = ValueKind::kBrdf;
    if (options_.value_kind) {
      layout_.value_kind = *options_.value_kind;
      origin = "option";
    } else if (header_.value_kind) {
      layout_.value_kind = *header_.value_kind;
      origin = "header";
    } else if (by_name) {
      layout_.value_kind = *by_name;
      origin = "column name";
    }
    measurement_->conventions["value-kind"] = std::string(Name(layout_.value_kind)) + " (" + origin + ")";
  }

  const InputFile& file_;
  const CsvHeader& header_;
  const ReadOptions& options_;
  Measurement* measurement_;
  CsvLayout layout_;
  std::size_t chosen_ = kNoColumn;
};

}  // namespace

CsvLayout ReadCsvLayout(const InputFile& file, const CsvHeader& header, const ReadOptions& options,
                        Measurement* notes) {
  return LayoutBuilder(file, header, options, notes).Build();
}

}  // namespace lobefit
