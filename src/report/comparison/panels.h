// The panels of a comparison. Makers as in panel.h: nothing where the measurement cannot fill the panel.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobefit/report/panels/panel.h"

namespace lobefit {

struct Compared {
  struct Entry {
    std::unique_ptr<ReportData> data;
    std::string label, note;
    Rgb color;
  };
  std::vector<Entry> models;  // at least one; all of one measurement
  int threads = 1;

  const ReportData& first() const { return *models.front().data; }
};

std::optional<Panel> ComparedErrorsPanel(const Compared& compared);
std::optional<Panel> ComparedCurvesPanel(const Compared& compared);
std::optional<Panel> ComparedRatiosPanel(const Compared& compared);
std::optional<Panel> ComparedSpheresPanel(const Compared& compared);

}  // namespace lobefit
