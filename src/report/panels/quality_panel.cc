// Whether to believe the numbers: error under each metric, what was set aside, what the data do not determine, how the
// search ended.
#include <algorithm>
#include <cmath>

#include "lobefit/measurement/set_aside.h"
#include "lobefit/plot/style.h"
#include "lobefit/plot/table.h"
#include "lobefit/report/panels/panel.h"

namespace lobefit {
namespace {

std::string Words(const std::string& reason_key) {
  for (int i = 0; i < kSetAsideReasons; ++i) {
    const auto reason = static_cast<SetAsideReason>(i);
    if (Key(reason) == reason_key) return std::string(Words(reason));
  }
  return reason_key;
}

// Formula of a metric as math, for those that a reader may not know by name.
std::string Formula(const std::string& metric) {
  if (metric == "log") return "ln(1 + f_r cosθ_i)";
  if (metric == "cube-root") return "(f_r cosθ_i)^{1/3}";
  if (metric == "relative") return "(f_r − m) / m";
  if (metric == "cosine-l2") return "f_r cosθ_i  (1/sr)";
  return "";
}

class Writer {
 public:
  Writer(Canvas* canvas, const Box& box, bool draw) : canvas_(canvas), box_(box), draw_(draw), y_(box.y) {}
  double y() const { return y_; }

  void Heading(const std::string& text) {
    y_ = DrawHeading(draw_ ? canvas_ : nullptr, box_.x, y_ + (y_ > box_.y ? 10 : 2), text);
  }

  void Row(const std::string& left, const std::string& middle, const std::string& right, bool strong) {
    y_ += kLineHeight;
    if (!draw_) return;
    const Weight weight = strong ? Weight::kBold : Weight::kRegular;
    canvas_->Text({box_.x, y_}, left, {.size = style::kBodySize, .color = style::kInk, .weight = weight});
    if (!middle.empty())
      canvas_->Text({box_.x + 0.27 * box_.width, y_}, middle,
                    {.size = style::kNoteSize, .color = style::kSecondary, .markup = true});
    canvas_->Text(
        {box_.right(), y_}, right,
        {.size = style::kBodySize, .color = style::kInk, .weight = weight, .align = Align::kRight, .markup = true});
  }

  // Shares of a whole as one bar.
  void Bar(const std::vector<std::pair<double, Rgb>>& shares) {
    y_ += 6;
    double x = box_.x;
    for (const auto& [share, color] : shares) {
      if (draw_) canvas_->Fill({x, y_, share * box_.width, 8}, color);
      x += share * box_.width;
    }
    y_ += 10;
  }

  void Warning(const std::string& text) {
    const std::vector<std::string> lines = canvas_->Wrap(text, style::Note(), box_.width - 24);
    const double height = 16.0 * static_cast<double>(lines.size()) + 10;
    y_ += 5;
    if (draw_) {
      canvas_->Fill({box_.x, y_, box_.width, height}, style::kWarningShade);
      canvas_->Fill({box_.x, y_, 3, height}, style::kWarning);
      for (std::size_t i = 0; i < lines.size(); ++i) {
        canvas_->Text({box_.x + 12, y_ + 17 + 16 * static_cast<double>(i)}, lines[i], style::Note(style::kWarning));
      }
    }
    y_ += height;
  }

  void Lines(const std::string& text) {
    y_ += 6;
    for (const std::string& line : canvas_->Wrap(text, style::Note(), box_.width)) {
      y_ += 16;
      if (draw_) canvas_->Text({box_.x, y_}, line, style::Note());
    }
  }

 private:
  Canvas* canvas_;
  Box box_;
  bool draw_;
  double y_;
};

double Write(const ReportData& data, Canvas* canvas, const Box& box, bool draw) {
  const Material& material = data.material;
  Writer writer(canvas, box, draw);
  for (const std::string& direction : material.degenerate) writer.Warning("Not determined: " + direction);
  if (!material.termination.converged) {
    writer.Warning("The search did not converge: " +
                   (material.termination.message.empty() ? "no reason given" : material.termination.message));
  }
  if (!material.errors.empty()) {
    writer.Heading("Root mean square error");
    for (const MetricError& error : material.errors) {
      writer.Row(error.metric, Formula(error.metric), Number(error.rms, 3), error.metric == material.metric);
    }
  }
  writer.Heading("Samples");
  const std::size_t read = std::max<std::size_t>(material.samples_read, material.samples_used);
  writer.Row("used", "", Count(material.samples_used) + " of " + Count(read), true);
  if (read > 0) {
    const double used = static_cast<double>(material.samples_used) / static_cast<double>(read);
    writer.Bar({{used, style::kBlue}, {1 - used, style::kRule}});
  }
  for (const auto& [reason, count] : material.set_aside) {
    if (count > 0) writer.Row(Words(reason), "", Count(count), false);
  }
  for (const std::string& remark : material.remarks) writer.Lines(remark);
  return writer.y() + 10;
}

}  // namespace

std::optional<Panel> QualityPanel(const ReportData& data) {
  Panel panel;
  panel.id = "quality";
  panel.title = "Fit and data";
  panel.wide = false;
  panel.height = [&data](Canvas* canvas, double width) { return Write(data, canvas, {0, 0, width, 0}, false); };
  panel.draw = [&data](Canvas* canvas, const Box& content) { Write(data, canvas, content, true); };
  return panel;
}

}  // namespace lobefit
