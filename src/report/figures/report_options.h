// How pictures are drawn.
#pragma once

#include <string>
#include <vector>

namespace lobefit {

struct ReportOptions {
  int threads = 1;
  // Pixels to one page unit. The page is 1320 units wide; text is at least 11 units high.
  double scale = 2;
  // Folders searched for DejaVu fonts; empty: the usual places. Without them OpenCV's stroke font is used.
  std::vector<std::string> font_folders;
};

}  // namespace lobefit
