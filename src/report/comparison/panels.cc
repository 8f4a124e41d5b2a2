#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/directions.h"
#include "lobefit/plot/axes.h"
#include "lobefit/plot/color.h"
#include "lobefit/plot/style.h"
#include "lobefit/report/comparison/panels.h"
#include "lobefit/report/figures/isotropic_lookup.h"
#include "lobefit/report/figures/slices.h"
#include "lobefit/report/panels/page.h"
#include "lobefit/report/panels/sphere.h"

namespace lobefit {
namespace {

std::vector<LegendEntry> ModelLegend(const Compared& compared) {
  std::vector<LegendEntry> legend;
  for (const Compared::Entry& entry : compared.models)
    legend.push_back({LegendEntry::Mark::kLine, entry.color, entry.label});
  return legend;
}

std::size_t FreeValues(const Material& material) {
  std::size_t free = 0;
  for (const FittedParameter& parameter : material.parameters) free += parameter.free ? parameter.values.size() : 0;
  // Of each lobe its shape, and an amplitude a channel; the constants.
  for (const SelSlice& slice : material.sel ? material.sel->slices : std::vector<SelSlice>()) {
    free += 5 * slice.lobes.size() + (slice.lobes.size() + 1) * slice.constant.size();
  }
  return free;
}

// --- errors

constexpr double kRow = 40, kHead = 22;

void DrawErrors(const Compared& compared, Canvas* canvas, const Box& content) {
  std::vector<std::string> metrics;
  for (const MetricError& error : compared.first().material.errors) metrics.push_back(error.metric);
  const double name_width = content.width * 0.5, free_width = 70;
  const double column =
      (content.width - name_width - free_width) / std::max<double>(1, static_cast<double>(metrics.size()));
  const auto right_of = [&](std::size_t k) {
    return content.x + name_width + free_width + column * static_cast<double>(k + 1);
  };
  canvas->Text({content.x + name_width + free_width, content.y + 12}, "free",
               style::Note(style::kSecondary, Align::kRight));
  for (std::size_t k = 0; k < metrics.size(); ++k)
    canvas->Text({right_of(k), content.y + 12}, "rms, " + metrics[k], style::Note(style::kSecondary, Align::kRight));
  std::map<std::string, double> least;
  const auto find = [](const Material& material, const std::string& metric) {
    for (const MetricError& error : material.errors) {
      if (error.metric == metric) return error.rms;
    }
    return std::nan("");
  };
  for (const std::string& metric : metrics) {
    least[metric] = std::nan("");
    for (const Compared::Entry& entry : compared.models)
      least[metric] = std::fmin(least[metric], find(entry.data->material, metric));
  }
  double y = content.y + kHead;
  for (const Compared::Entry& entry : compared.models) {
    const Material& material = entry.data->material;
    canvas->Line({content.x, y}, {content.right(), y}, {style::kRule, 1});
    canvas->Fill({content.x, y + 7, 18, 5}, entry.color);
    TextStyle name = style::Body();
    name.weight = Weight::kBold;
    canvas->Text({content.x + 28, y + 15}, canvas->Shorten(entry.label, name, name_width - 40), name);
    std::vector<std::string> words;
    if (!entry.note.empty()) words.push_back(entry.note);
    if (!material.termination.converged) words.emplace_back("not converged");
    words.push_back(ModelWords(material.model));
    canvas->Text({content.x + 28, y + 31}, canvas->Shorten(Join(words, "  ·  "), style::Note(), name_width - 40),
                 style::Note());
    canvas->Text({content.x + name_width + free_width, y + 15}, std::to_string(FreeValues(material)),
                 style::Body(style::kInk, Align::kRight));
    for (std::size_t k = 0; k < metrics.size(); ++k) {
      const double rms = find(material, metrics[k]);
      if (std::isnan(rms)) continue;
      TextStyle text = style::Body(style::kInk, Align::kRight);
      text.markup = true;
      if (rms <= least[metrics[k]]) text.weight = Weight::kBold;
      canvas->Text({right_of(k), y + 15}, Number(rms, 3), text);
    }
    y += kRow;
  }
}

// --- curves

constexpr std::size_t kMostRows = 2, kMostColumns = 3;
constexpr double kLeft = 60, kBottom = 40, kGapX = 16, kGapY = 18, kStripShare = 0.3, kStripGap = 8;

struct Curves {
  Slices slices;
  std::vector<const Slice*> chosen;
  std::size_t rows = 0, columns = 0;
  bool azimuths = false;
  Range values;
  double ratio = 2;
};

struct Line {
  std::vector<double> degrees, value;
};

Line EvaluateLine(const ReportData& data, const Slices& slices, const Slice& slice) {
  Line line;
  std::vector<double> f_r(data.channels());
  for (int k = -359; k <= 359; ++k) {
    Vec3 wi, wo;
    SliceDirections(slices, slice, DegreesToRadians(k * 0.25), &wi, &wo);
    data.fitted.Evaluate(wi, wo, f_r.data());
    line.degrees.push_back(k * 0.25);
    line.value.push_back(data.Display(f_r));
  }
  return line;
}

double FittedDisplay(const ReportData& data, std::size_t sample) {
  double sum = 0;
  for (std::size_t c = 0; c < data.channels(); ++c)
    sum += data.display_weights[c] * static_cast<double>(data.fitted_values[c][sample]);
  return sum;
}

void FindRanges(const Compared& compared, Curves* curves) {
  std::vector<double> measured, ratios;
  double high = 0;
  for (const Slice* slice : curves->chosen) {
    if (slice == nullptr) continue;
    for (const SlicePoint& point : slice->points) {
      const double m = compared.first().Display(compared.first().measurement.samples.values, point.sample);
      high = std::max(high, m);
      if (!(m > 0)) continue;
      measured.push_back(m);
      for (const Compared::Entry& entry : compared.models) {
        const double f = FittedDisplay(*entry.data, point.sample);
        if (f > 0) ratios.push_back(std::fabs(std::log(m / f)));
      }
    }
  }
  if (!(high > 0)) high = 1;
  double low = high / 10;
  if (!measured.empty()) low = std::min(low, Quantile(&measured, 0.02) / 2);
  curves->values = LogRangeAround(std::max(low, high * 1e-6), high * 1.5);
  const double spread = ratios.empty() ? 0.1 : Quantile(&ratios, 0.9);
  curves->ratio = 10;
  for (const double nice : {5.0, 3.0, 2.0, 1.5, 1.2, 1.1, 1.05}) {
    if (std::log(nice) >= spread) curves->ratio = nice;
  }
}

// Below each slice, measured / fitted at the samples, joined: which model follows the data where.
void DrawStrip(const Compared& compared, const Slice& slice, const Axes& axes, double reach, Canvas* canvas) {
  const Canvas::Clip clip(canvas, axes.frame());
  canvas->Line(axes.Map(-90, 1), axes.Map(90, 1), {style::kFaint, 1});
  for (auto entry = compared.models.rbegin(); entry != compared.models.rend(); ++entry) {
    std::vector<Point> line;
    double last = -1e9;
    for (const SlicePoint& point : slice.points) {
      const double m = entry->data->Display(entry->data->measurement.samples.values, point.sample),
                   f = FittedDisplay(*entry->data, point.sample), x = RadiansToDegrees(point.theta);
      // A gap in the data is one in the line.
      if (x - last > 12 || !(m > 0) || !(f > 0)) line.push_back({std::nan(""), std::nan("")});
      if (m > 0 && f > 0) line.push_back(axes.Map(x, std::clamp(m / f, 1 / reach, reach)));
      last = x;
    }
    canvas->Polyline(line, {entry->color, 1, 0.9});
  }
}

void DrawSlice(const Compared& compared, const Curves& curves, const Slice& slice, Canvas* canvas, const Box& cell,
               bool x_labels, bool y_labels) {
  const double strip = std::round(cell.height * kStripShare);
  const Box main = {cell.x, cell.y, cell.width, cell.height - strip - kStripGap},
            under = {cell.x, cell.bottom() - strip, cell.width, strip};
  const double reach = std::pow(curves.ratio, 1.4);
  const Axes axes(main, {-90, 90, false}, curves.values), strip_axes(under, {-90, 90, false}, {1 / reach, reach, true});
  std::vector<Tick> x_ticks = AngleTicks(-90, 90, 6);
  for (Tick& tick : x_ticks) {
    if (std::fabs(tick.value) > 89) tick.label.clear();
  }
  const std::vector<Tick> y_ticks =
      LogTicks(curves.values.low, curves.values.high, std::max(3, static_cast<int>(main.height / 34)));
  const std::vector<Tick> ratio_ticks = {
      {1 / curves.ratio, RatioText(1 / curves.ratio)}, {1, "1"}, {curves.ratio, RatioText(curves.ratio)}};
  axes.DrawGrid(canvas, x_ticks, y_ticks);
  strip_axes.DrawGrid(canvas, x_ticks, ratio_ticks);
  const ReportData& data = compared.first();
  {
    const Canvas::Clip clip(canvas, main);
    const double mirror = axes.MapX(RadiansToDegrees(slice.theta));
    canvas->Line({mirror, main.y}, {mirror, main.bottom()}, {style::kFaint, 1, 1, 4, 3});
    const double radius = slice.points.size() > 400 ? 1.4 : slice.points.size() > 120 ? 1.8 : 2.4;
    for (const SlicePoint& point : slice.points) {
      const double m = data.Display(data.measurement.samples.values, point.sample);
      if (m >= curves.values.low) canvas->Disc(axes.Map(RadiansToDegrees(point.theta), m), radius, style::kFaint, 0.7);
    }
    // The best one last, on top.
    for (auto entry = compared.models.rbegin(); entry != compared.models.rend(); ++entry) {
      const Line line = EvaluateLine(*entry->data, curves.slices, slice);
      std::vector<Point> points;
      for (std::size_t k = 0; k < line.degrees.size(); ++k)
        points.push_back(axes.Map(line.degrees[k], std::max(line.value[k], curves.values.low * 1e-2)));
      canvas->Polyline(points, {entry->color, 1.3});
    }
  }
  DrawStrip(compared, slice, strip_axes, reach, canvas);
  axes.DrawFrame(canvas, x_ticks, y_ticks, false, y_labels);
  if (y_labels) axes.DrawYLabel(canvas, "f_r  (1/sr)", kLeft - 14);
  strip_axes.DrawFrame(canvas, x_ticks, ratio_ticks, x_labels, y_labels);
  TextStyle text = {.size = style::kBodySize,
                    .color = style::kInk,
                    .weight = Weight::kBold,
                    .baseline = Baseline::kTop,
                    .markup = true};
  const char* side = curves.slices.outgoing_stays ? "_o = " : "_i = ";
  canvas->Text({main.x + 8, main.y + 8}, "θ" + (side + Degrees(slice.theta)), text);
  if (curves.azimuths) {
    text.weight = Weight::kRegular;
    text.color = style::kSecondary;
    canvas->Text({main.x + 8, main.y + 25}, "φ" + (side + Degrees(slice.phi)), text);
  }
}

void DrawCurves(const Compared& compared, const Curves& curves, Canvas* canvas, const Box& content) {
  const Box area = Inset(content, kLeft, 4, 4, kBottom + 22);
  const double width =
      (area.width - kGapX * static_cast<double>(curves.columns - 1)) / static_cast<double>(curves.columns);
  const double height = (area.height - kGapY * static_cast<double>(curves.rows - 1)) / static_cast<double>(curves.rows);
  for (std::size_t i = 0; i < curves.chosen.size(); ++i) {
    if (curves.chosen[i] == nullptr) continue;
    const std::size_t row = i / curves.columns, column = i % curves.columns;
    const bool last = i + curves.columns >= curves.chosen.size() || curves.chosen[i + curves.columns] == nullptr;
    DrawSlice(compared, curves, *curves.chosen[i], canvas,
              {area.x + static_cast<double>(column) * (width + kGapX),
               area.y + static_cast<double>(row) * (height + kGapY), width, height},
              last, column == 0);
  }
  const Axes whole(area, {0, 1, false}, {0, 1, false});
  whole.DrawXLabel(canvas, curves.slices.outgoing_stays ? "θ_i  (degrees; the mirror direction, dashed, is positive)"
                                                        : "θ_o  (degrees; the mirror direction, dashed, is positive)");
  std::string note = "Lower strips: measured / fitted.";
  if (compared.first().channels() > 1) note += " One number a sample: luminance, or the mean of the channels.";
  canvas->Text({area.x, content.bottom() - 4}, note, style::Note());
}

// --- ratios

struct Ratios {
  std::vector<std::vector<NamedField>> fields;  // [model]
  bool round = false;                           // hemispheres, not theta_h against theta_d
  std::size_t rows = 1;
};

constexpr double kFieldGap = 14, kFieldHead = 22;

double FieldSide(double width, std::size_t count) {
  return std::min(240.0, (width - 52 - kFieldGap * static_cast<double>(count - 1)) / static_cast<double>(count));
}

double FieldRow(const Ratios& ratios, double side) { return side + (ratios.round ? 8 : 46); }

void DrawRatios(const Compared& compared, const Ratios& ratios, Canvas* canvas, const Box& content) {
  const std::size_t count = ratios.fields.size();
  std::vector<const FieldImage*> images;
  for (const auto& fields : ratios.fields) {
    for (std::size_t row = 0; row < ratios.rows; ++row) images.push_back(fields[row].image.get());
  }
  const FieldScale scale(images);
  const double side = FieldSide(content.width, count);
  const double left = content.x + 52;
  for (std::size_t k = 0; k < count; ++k) {
    const double x = left + static_cast<double>(k) * (side + kFieldGap);
    const Compared::Entry& entry = compared.models[k];
    TextStyle name = style::Body(style::kInk, Align::kCenter);
    canvas->Fill({x, content.y + 16, side, 3}, entry.color);
    canvas->Text({x + side / 2, content.y + 11}, canvas->Shorten(entry.label, name, side), name);
    for (std::size_t row = 0; row < ratios.rows; ++row) {
      const FieldImage& image = *ratios.fields[k][row].image;
      const cv::Mat picture =
          Picture(image.log_ratio, image.width, image.height, [&scale](float v) { return scale.RatioColor(v); });
      const Box frame = {x, content.y + kFieldHead + static_cast<double>(row) * FieldRow(ratios, side), side, side};
      if (ratios.round) {
        canvas->Image(RoundPicture(picture, static_cast<int>(std::lround(side * canvas->scale()))), frame, false);
        canvas->Ring(frame.center(), side / 2, {style::kSecondary, 1});
      } else {
        canvas->Image(picture, frame, true);
        const Axes axes(frame, {0, 90, false}, {0, 90, false});
        const std::vector<Tick> ticks = AngleTicks(0, 90, 4);
        axes.DrawFrame(canvas, ticks, ticks, true, k == 0);
        axes.DrawXLabel(canvas, "θ_h  (degrees)");
        if (k == 0) axes.DrawYLabel(canvas, "θ_d  (degrees)", 36);
      }
    }
  }
  scale.DrawRatios(canvas, left, left + std::max(400.0, static_cast<double>(count) * (side + kFieldGap) - kFieldGap),
                   content.y + kFieldHead + static_cast<double>(ratios.rows) * FieldRow(ratios, side));
}

// --- spheres

struct Ball {
  LitSphere lit;
  std::string label;
  Rgb color;
};

constexpr int kBallPixels = 200;

double BallSide(double width, std::size_t count) {
  return std::min(200.0, (width - 14 * static_cast<double>(count - 1)) / static_cast<double>(count));
}

void DrawBalls(const std::vector<Ball>& balls, Canvas* canvas, const Box& content) {
  const double exposure = SphereExposure(balls.front().lit), side = BallSide(content.width, balls.size());
  double x = content.x;
  for (const Ball& ball : balls) {
    cv::Mat picture(ball.lit.size, ball.lit.size, CV_8UC4);
    for (int row = 0; row < ball.lit.size; ++row) {
      for (int column = 0; column < ball.lit.size; ++column) {
        const std::size_t i = PixelIndex(column, row, ball.lit.size);
        const Rgb c = ball.lit.known[i] != 0 ? ToScreen(ball.lit.color[i], exposure) : style::kRule;
        picture.at<cv::Vec4b>(row, column) = {c.r, c.g, c.b, 255};
      }
    }
    const TextStyle name = style::Body(style::kInk, Align::kCenter);
    canvas->Text({x + side / 2, content.y + 12}, canvas->Shorten(ball.label, name, side), name);
    canvas->Fill({x, content.y + 17, side, 3}, ball.color);
    canvas->Image(RoundPicture(picture, static_cast<int>(std::lround(side * canvas->scale()))),
                  {x, content.y + 26, side, side}, false);
    x += side + 14;
  }
}

}  // namespace

std::optional<Panel> ComparedErrorsPanel(const Compared& compared) {
  Panel panel;
  panel.id = "errors";
  panel.title = "Root mean square error on all samples; the least of each column is bold";
  panel.height = [&compared](Canvas*, double) { return kHead + kRow * static_cast<double>(compared.models.size()); };
  panel.draw = [&compared](Canvas* canvas, const Box& content) { DrawErrors(compared, canvas, content); };
  return panel;
}

std::optional<Panel> ComparedCurvesPanel(const Compared& compared) {
  const auto curves = std::make_shared<Curves>();
  curves->slices = compared.first().slices();
  curves->chosen = ChooseSlices(curves->slices, kMostRows, kMostColumns, &curves->rows, &curves->columns);
  if (curves->chosen.empty()) return std::nullopt;
  for (const Slice* slice : curves->chosen)
    curves->azimuths = curves->azimuths || (slice != nullptr && std::fabs(slice->phi - curves->chosen[0]->phi) > 0.01);
  FindRanges(compared, curves.get());
  Panel panel;
  panel.id = "curves";
  panel.title = "In-plane curves";
  panel.legend = ModelLegend(compared);
  panel.legend.insert(panel.legend.begin(), {LegendEntry::Mark::kDot, style::kFaint, "measured"});
  panel.height = [curves](Canvas*, double) {
    return static_cast<double>(curves->rows) * (curves->rows == 1 ? 400.0 : 330.0) + kBottom + 30;
  };
  panel.draw = [&compared, curves](Canvas* canvas, const Box& content) {
    DrawCurves(compared, *curves, canvas, content);
  };
  return panel;
}

std::optional<Panel> ComparedRatiosPanel(const Compared& compared) {
  const auto ratios = std::make_shared<Ratios>();
  ratios->fields.resize(compared.models.size());
  for (std::size_t k = 0; k < compared.models.size(); ++k) {
    // The maps that a report of the model alone shows.
    std::optional<Panel> maps = BurleyPanel(*compared.models[k].data);
    if (!maps) {
      maps = MapsPanel(*compared.models[k].data);
      ratios->round = true;
    }
    if (!maps || maps->fields.empty()) return std::nullopt;
    ratios->fields[k] = maps->fields;
    ratios->rows = std::min<std::size_t>(2, maps->fields.size());
  }
  Panel panel;
  panel.id = "ratios";
  panel.title = "Measured / fitted";
  if (ratios->round) {
    std::string which = "all outgoing directions;";
    const char* const places[] = {"above", "below"};
    for (std::size_t row = 0; row < ratios->rows; ++row) {
      which += (ratios->rows > 1 ? "  " + std::string(places[row]) + ": " : " ") + ratios->fields[0][row].title;
      if (row + 1 < ratios->rows) which += ";";
    }
    panel.legend = {{LegendEntry::Mark::kNone, {}, which}};
  }
  panel.height = [ratios](Canvas*, double width) {
    return kFieldHead + static_cast<double>(ratios->rows) * FieldRow(*ratios, FieldSide(width, ratios->fields.size())) +
           FieldScale::kHeight;
  };
  panel.draw = [&compared, ratios](Canvas* canvas, const Box& content) {
    DrawRatios(compared, *ratios, canvas, content);
  };
  return panel;
}

std::optional<Panel> ComparedSpheresPanel(const Compared& compared) {
  const ReportData& first = compared.first();
  const ChannelColor to_color(first.measurement.channels);
  const auto balls = std::make_shared<std::vector<Ball>>();
  if (std::optional<LitSphere> measured = LightMeasured(first.measurement, to_color, kBallPixels))
    balls->push_back({std::move(*measured), "measured", style::kFaint});
  for (const Compared::Entry& entry : compared.models)
    balls->push_back({LightSphere(Shown(entry.data->fitted), to_color, entry.data->channels(), LitRows(kBallPixels)),
                      entry.label, entry.color});
  Panel panel;
  panel.id = "spheres";
  panel.title = "Spheres under one light";
  panel.height = [balls](Canvas*, double width) { return 34 + BallSide(width, balls->size()); };
  panel.draw = [balls](Canvas* canvas, const Box& content) { DrawBalls(*balls, canvas, content); };
  return panel;
}

}  // namespace lobefit
