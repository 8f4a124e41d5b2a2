// A folder with measurements for `lobefit batch`, some of them broken.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lobefit/batch/list/csv_text.h"

namespace lobefit {

class BatchTest : public ProgramTest {
 protected:
  // `count` synthetic measurements data/m000.csv and so on.
  void MakeFiles(int count) const {
    std::filesystem::create_directories(folder_ / "data");
    const std::string head = ReadWholeFile(test::SourceDir() / "samples" / "satin_plastic.csv");
    // The same measurement with another number of rows each: other contents, other results.
    for (int i = 0; i < count; ++i) {
      std::size_t end = head.size();
      for (int k = 0; k <= i; ++k) end = head.rfind('\n', end - 2);
      WriteWholeFile(folder_ / "data" / fmt::format("m{:03}.csv", i), head.substr(0, end + 1));
    }
  }
  void MakeBrokenFiles() const {
    std::filesystem::create_directories(folder_ / "data");
    WriteWholeFile(folder_ / "data" / "broken_empty.csv", "");
    WriteWholeFile(folder_ / "data" / "broken_text.csv", "this is, no measurement\n");
    WriteWholeFile(folder_ / "data" / "broken_row.csv", "theta_i,phi_i,theta_o,phi_o,value\n20,0,20,180\n");
  }
  // Rows of a table by their id, each as texts by column.
  std::map<std::string, std::map<std::string, std::string>> Table(const std::filesystem::path& path) const {
    const std::string text = ReadWholeFile(folder_ / path);
    CsvRecords records(text, path.string());
    std::vector<std::string> columns, fields;
    std::map<std::string, std::map<std::string, std::string>> rows;
    if (!records.Next(&columns)) return rows;
    while (records.Next(&fields)) {
      std::map<std::string, std::string> row;
      for (std::size_t i = 0; i < fields.size() && i < columns.size(); ++i) row[columns[i]] = fields[i];
      EXPECT_TRUE(rows.emplace(fields[0], row).second) << fields[0] << " has two rows";
    }
    return rows;
  }
  bool Same(const std::filesystem::path& a, const std::filesystem::path& b) const {
    const std::string text = ReadWholeFile(folder_ / a);
    return !text.empty() && text == ReadWholeFile(folder_ / b);
  }
};

}  // namespace lobefit
