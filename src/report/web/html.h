// The live page of a report.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lobefit/report/panels/page.h"
#include "lobefit/report/web/html.h"

namespace lobefit {

// The whole live page.
std::string ReportHtml(const ReportData& data, const std::vector<Panel>& panels, const std::shared_ptr<Fonts>& fonts);

}  // namespace lobefit
