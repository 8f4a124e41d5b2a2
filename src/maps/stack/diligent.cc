#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {

StackFiles ReadDiligent(const std::filesystem::path& folder) {
  StackFiles files;
  Stack& stack = files.stack;
  stack.layout = "DiLiGenT folder";
  const FileBytes names(folder / "filenames.txt");
  LineReader lines(names.bytes());
  for (std::string_view line; lines.Next(&line);) {
    const std::string_view name = Trim(line);
    if (!name.empty()) stack.images.push_back(folder / std::string(name));
  }
  const std::filesystem::path table = folder / "light_directions.txt", intensities = folder / "light_intensities.txt";
  for (const std::vector<double>& row : ReadTable(table, 3)) {
    stack.lights.push_back({LightDirection(row[0], row[1], row[2],
                                           fmt::format("{}, light {}", PrintableName(table), stack.lights.size() + 1)),
                            {1, 1, 1}});
  }
  if (stack.images.size() != stack.lights.size()) {
    throw InputError(fmt::format("{}: {} lights, but {} images in filenames.txt; one light an image is expected",
                                 PrintableName(table), stack.lights.size(), stack.images.size()));
  }
  const std::vector<std::vector<double>> rows = ReadTable(intensities, 3);
  if (rows.size() != stack.lights.size()) {
    throw InputError(fmt::format("{}: {} intensities, but {} lights; one row R G B a light is expected",
                                 PrintableName(intensities), rows.size(), stack.lights.size()));
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(rows[i][c] > 0)) {
        throw InputError(
            fmt::format("{}, light {}: intensity {} is not positive", PrintableName(intensities), i + 1, rows[i][c]));
      }
      stack.lights[i].intensity[c] = rows[i][c];
    }
  }
  stack.response.curve = Response::Curve::kLinear;  // as the layout is defined
  files.mask = folder / "mask.png";
  std::error_code error;
  if (!std::filesystem::exists(files.mask, error)) files.mask.clear();
  return files;
}

}  // namespace lobefit
