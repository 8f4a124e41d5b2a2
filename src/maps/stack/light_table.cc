#include <cmath>

#include <fmt/format.h>

#include "lobefit/base/error.h"
#include "lobefit/base/files/file.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/maps/stack/layouts.h"

namespace lobefit {

std::vector<std::vector<double>> ReadTable(const std::filesystem::path& file, std::size_t columns) {
  const FileBytes bytes(file);
  LineReader lines(bytes.bytes());
  std::vector<std::vector<double>> rows;
  for (std::string_view line; lines.Next(&line);) {
    const std::string_view text = Trim(line);
    if (text.empty() || text.front() == '#') continue;
    std::vector<double> row;
    for (const std::string_view field : SplitBlanks(text)) {
      const std::optional<double> number = ParseDouble(field);
      if (!number || !std::isfinite(*number)) {
        throw InputError(fmt::format("{}:{}: '{}' is no finite number; {} numbers a line are expected",
                                     PrintableName(file), lines.line_number(), Excerpt(field), columns));
      }
      row.push_back(*number);
    }
    if (!rows.empty() && row.size() != rows.front().size()) {
      throw InputError(fmt::format("{}:{}: {} numbers, but {} in the lines before", PrintableName(file),
                                   lines.line_number(), row.size(), rows.front().size()));
    }
    rows.push_back(std::move(row));
  }
  if (rows.size() == columns && rows.front().size() != columns) {
    std::vector<std::vector<double>> turned(rows.front().size(), std::vector<double>(columns));
    for (std::size_t i = 0; i < turned.size(); ++i) {
      for (std::size_t j = 0; j < columns; ++j) turned[i][j] = rows[j][i];
    }
    return turned;
  }
  if (!rows.empty() && rows.front().size() != columns) {
    throw InputError(
        fmt::format("{}: {} numbers a line; {} are expected", PrintableName(file), rows.front().size(), columns));
  }
  return rows;
}

void SetNear(NearLights near, double width_mm, const std::string& name, Stack* stack) {
  for (std::size_t l = 0; l < stack->lights.size(); ++l) {
    const Vec3& place = stack->lights[l].place;
    if (!(place.z > 0)) {
      throw InputError(fmt::format("{}: light {} at z = {} mm is not in front of the picture, whose plane is z = 0",
                                   name, l + 1, place.z));
    }
    near.reference_mm += Norm(place) / static_cast<double>(stack->lights.size());
  }
  stack->near = near, stack->width_mm = width_mm;
}

void SetCameras(const std::vector<Vec3>& cameras, double width_mm, const std::string& name, Stack* stack) {
  for (std::size_t k = 0; k < cameras.size(); ++k) {
    if (!(cameras[k].z > 0)) {
      throw InputError(fmt::format("{}: camera {} at z = {} mm is not in front of the picture, whose plane is z = 0",
                                   name, k + 1, cameras[k].z));
    }
  }
  stack->cameras = cameras, stack->width_mm = width_mm;
}

Vec3 LightDirection(double x, double y, double z, const std::string& place) {
  const Vec3 w = {x, y, z};
  const double length = Norm(w);
  if (!std::isfinite(length) || length < 1e-4) {
    throw InputError(
        fmt::format("{}: ({}, {}, {}) is no direction; x right, y up, z to the camera are expected", place, x, y, z));
  }
  return (1 / length) * w;
}

}  // namespace lobefit
