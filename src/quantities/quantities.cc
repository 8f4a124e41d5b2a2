#include "lobefit/quantities/quantities.h"

#include <algorithm>
#include <cmath>

#include "lobefit/base/text/text.h"
#include "lobefit/quantities/quantity_columns.h"

namespace lobefit {
namespace {

std::vector<Quantity> AllQuantities() {
  std::vector<Quantity> all;
  for (auto* part : {WalterQuantities, HeitzQuantities, SelQuantities, DEonQuantities, LoubetQuantities,
                     InstrumentQuantities, ProfileQuantities, LayerQuantities}) {
    for (Quantity& quantity : part()) all.push_back(std::move(quantity));
  }
  std::sort(all.begin(), all.end(), [](const Quantity& a, const Quantity& b) { return a.name < b.name; });
  return all;
}

bool InDomain(const InputColumn& column, double value) {
  return (column.low_open ? value > column.low : value >= column.low) &&
         (column.high_open ? value < column.high : value <= column.high);
}

}  // namespace

const std::vector<Quantity>& Quantities() {
  static const std::vector<Quantity> all = AllQuantities();
  return all;
}

const Quantity* FindQuantity(std::string_view name) {
  for (const Quantity& quantity : Quantities()) {
    if (quantity.name == name) return &quantity;
  }
  return nullptr;
}

std::string DomainText(const InputColumn& column) {
  if (!column.words.empty()) return "one of " + Join(column.words);
  if (std::isinf(column.low) && std::isinf(column.high)) return "any finite number";
  if (std::isinf(column.high)) return (column.low_open ? "> " : ">= ") + FormatDouble(column.low);
  return std::string("in ") + (column.low_open ? "(" : "[") + FormatDouble(column.low) + ", " +
         FormatDouble(column.high) + (column.high_open ? ")" : "]");
}

std::optional<DomainError> CheckDomain(const Quantity& quantity, const double* inputs) {
  for (std::size_t i = 0; i < quantity.inputs.size(); ++i) {
    const InputColumn& column = quantity.inputs[i];
    if (!column.words.empty()) continue;
    if (!std::isfinite(inputs[i])) {
      return DomainError{i, FormatDouble(inputs[i]) + " is not finite; allowed: " + DomainText(column)};
    }
    if (!InDomain(column, inputs[i])) {
      return DomainError{i, FormatDouble(inputs[i]) + " is out of domain; allowed: " + DomainText(column)};
    }
  }
  for (const std::size_t i : quantity.directions) {
    if (inputs[i] == 0 && inputs[i + 1] == 0 && inputs[i + 2] == 0) {
      return DomainError{i, "the direction (0, 0, 0) has no length; allowed: any other vector, it is normalised"};
    }
  }
  return quantity.check == nullptr ? std::nullopt : quantity.check(inputs);
}

InputColumn Positive(const std::string& name, const std::string& meaning) {
  InputColumn column{name, "1", meaning};
  column.low = 0;
  column.low_open = true;
  return column;
}

InputColumn AnyNumber(const std::string& name, const std::string& unit, const std::string& meaning) {
  return {name, unit, meaning};
}

InputColumn Within(const std::string& name, const std::string& unit, const std::string& meaning, double low,
                   double high, bool low_open, bool high_open) {
  return {name, unit, meaning, low, high, low_open, high_open};
}

std::vector<InputColumn> EllipsoidColumns() {
  return {Positive("alpha_x", "roughness along the first axis"), Positive("alpha_y", "roughness along the second axis"),
          AnyNumber("theta_x", "rad", "tilt about x, positive leans the lobe to +y"),
          AnyNumber("theta_y", "rad", "tilt about y, positive leans the lobe to -x"),
          AnyNumber("theta_z", "rad", "turn about the normal, positive is clockwise seen from +z")};
}

std::vector<InputColumn> SlopeShapeColumns() {
  return {Positive("alpha_x", "roughness of the slopes along x"),
          Positive("alpha_y", "roughness of the slopes along y"),
          Within("r", "1", "correlation of the slopes", -1, 1, true, true),
          AnyNumber("slope_x", "1", "mean slope along x, positive leans the normal to -x"),
          AnyNumber("slope_y", "1", "mean slope along y, positive leans the normal to -y")};
}

std::vector<InputColumn> SlopeColumns() {
  InputColumn kind{"kind", "text", "slope distribution"};
  kind.words = {"beckmann", "ggx"};
  std::vector<InputColumn> columns = SlopeShapeColumns();
  columns.insert(columns.begin(), kind);
  return columns;
}

std::vector<ResultColumn> MaskingColumns() {
  return {{"c", "1", "projected area of the mean surface, u_z - slope_x u_x - slope_y u_y"},
          {"q", "1", "alpha_o^2 sin^2(theta), squared width of the slopes along u"},
          {"a", "1", "c / sqrt(q), signed"},
          {"Lambda", "1", "Smith's Lambda(a)"},
          {"sigma", "1", "int D(m) <m.u> dm"}};
}

void AddDirection(Quantity* quantity, const std::string& prefix, const std::string& meaning) {
  quantity->directions.push_back(quantity->inputs.size());
  for (const char* axis : {"x", "y", "z"}) {
    quantity->inputs.push_back(AnyNumber(prefix + axis, "1", meaning + ", " + axis));
  }
}

void AddUpperDirection(Quantity* quantity, const std::string& prefix, const std::string& meaning) {
  AddDirection(quantity, prefix, meaning + ", above the horizon");
  quantity->inputs.back().low = 0;
  quantity->inputs.back().low_open = true;
}

void AddDerivatives(Quantity* quantity, std::string value, std::string value_unit,
                    const std::vector<std::string>& inputs) {
  for (const std::string& input : inputs) {
    std::string unit = value_unit;
    for (const InputColumn& column : quantity->inputs) {
      if (column.name == input && column.unit != "1") {
        unit = value_unit == column.unit ? "1" : value_unit + "/" + column.unit;
      }
    }
    quantity->results.push_back({"d" + value + "_d" + input, unit, ""});
  }
}

std::vector<std::string> ParameterNames(const Quantity& quantity) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < quantity.inputs.size(); ++i) {
    const auto within = [i](std::size_t first) { return i >= first && i < first + 3; };
    const bool direction = std::any_of(quantity.directions.begin(), quantity.directions.end(), within);
    if (!direction && quantity.inputs[i].words.empty()) names.push_back(quantity.inputs[i].name);
  }
  return names;
}

// In extended precision: the quotient is rounded once, and no square overflows.
Vec3 DirectionAt(const double* in) {
  const long double x = in[0], y = in[1], z = in[2], length = std::sqrt(x * x + y * y + z * z);
  return {static_cast<double>(x / length), static_cast<double>(y / length), static_cast<double>(z / length)};
}

ProjectedSlopes ExtendedProjection(const double* slopes, const double* u) {
  const Real x = u[0], y = u[1], z = u[2], length = std::sqrt(x * x + y * y + z * z);
  const Real c = (z - slopes[3] * x - slopes[4] * y) / length, A = slopes[0] * x / length, B = slopes[1] * y / length;
  const Real q = ((A + B) * (A + B) * (1 + Real{slopes[2]}) + (A - B) * (A - B) * (1 - Real{slopes[2]})) / 2;
  return {static_cast<double>(c), static_cast<double>(q), static_cast<double>(c / std::sqrt(q))};
}

}  // namespace lobefit
