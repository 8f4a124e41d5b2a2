// The page: the panels as pictures, and the same data live.
#include "lobefit/report/web/html.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "lobefit/base/process/parallel.h"
#include "lobefit/base/text/base64.h"
#include "lobefit/base/text/printable.h"
#include "lobefit/base/text/text.h"
#include "lobefit/material/badge.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/panels/page.h"
#include "lobefit/report/web/assets.h"
#include "lobefit/report/web/data.h"
#include "lobefit/report/web/template.h"

namespace lobefit {
namespace {

constexpr const char* kLobeGlsl =
#include "lobefit/core/brdf/lobe.glsl.inc"
    ;

// What stands in the picture, for those who do not see it: title and legend.
std::string Description(const Panel& panel) {
  std::vector<std::string> words;
  for (const LegendEntry& entry : panel.legend) words.push_back(entry.text);
  return words.empty() ? panel.title : Join({panel.title, ": ", Join(words, ", ")}, "");
}

struct Figure {
  std::string id, description, png;
  bool wide = true;
};

Figure DrawFigure(const Panel& panel, double scale, const std::shared_ptr<Fonts>& fonts) {
  const Canvas canvas = DrawPanelAlone(panel, panel.wide ? 850 : 430, scale, fonts);
  return {panel.id, Description(panel), EncodePng(canvas.pixels(), 0), panel.wide};
}

struct Contents {
  std::vector<Figure> figures;
  std::string data;
};

Contents MakeContents(const ReportData& data, const std::vector<Panel>& panels, bool live,
                      const std::shared_ptr<Fonts>& fonts) {
  constexpr std::size_t kMostBytes = 1500000;
  constexpr double kSharp = 1.5;  // on dense screens, unless the page would grow too large
  Contents contents;
  contents.figures.resize(panels.size());
  // The data and each figure at the same time.
  ParallelFor(panels.size() + 1, data.threads, [&](std::size_t k) {
    if (k > 0) {
      contents.figures[k - 1] = DrawFigure(panels[k - 1], kSharp, fonts);
    } else if (live) {
      contents.data = DataJson(data);
    }
  });
  std::size_t bytes = 0;
  for (const Figure& figure : contents.figures) bytes += figure.png.size();
  if (bytes > kMostBytes) {
    ParallelFor(panels.size(), data.threads,
                [&](std::size_t k) { contents.figures[k] = DrawFigure(panels[k], 1, fonts); });
  }
  return contents;
}

std::string FigureHtml(const Figure& figure) {
  return Join({"<figure id=\"", MarkupText(figure.id), "\"><img alt=\"", MarkupText(figure.description),
               "\" src=\"data:image/png;base64,", Base64(figure.png), "\"></figure>\n"},
              "");
}

// What the shader of the page evaluates; other models are shown in pictures only.
bool IsLive(const Model& model) {
  constexpr std::size_t kMostLobes = 8;  // of the shader
  const auto known = [](const Lobe& l) {
    const Family family = FamilyOf(l.ndf);
    return family != Family::kKagiwadaKalaba && family != Family::kSphericalGaussian;
  };
  return !model.lobes.empty() && model.lobes.size() <= kMostLobes &&
         std::all_of(model.lobes.begin(), model.lobes.end(), known);
}

std::string Number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "not determined";
}

// The parameters as text, for reading aloud and for copying.
std::string ParameterTable(const ReportData& data) {
  const std::vector<Parameter> parameters = Parameters(data.material.model);
  std::string rows;
  for (std::size_t p = 0; p < parameters.size() && p < data.material.parameters.size(); ++p) {
    const Parameter& parameter = parameters[p];
    const FittedParameter& fitted = data.material.parameters[p];
    const double factor = 1 / InsideFactor(parameter);
    for (std::size_t c = 0; c < fitted.values.size(); ++c) {
      const auto error = [&](const std::vector<double>& errors) {
        const bool known = fitted.free && c < errors.size() && std::isfinite(errors[c]) && errors[c] > 0;
        return known ? Number(errors[c] * factor, 2) : fitted.free ? "not determined" : "fixed";
      };
      std::string name = parameter.json_name;
      if (parameter.per_channel && fitted.values.size() > 1) name += " " + data.channel_names[c];
      rows += Join(
          {"<tr><th scope=\"row\">", MarkupText(name), "</th><td>", Number(fitted.values[c] * factor, 6), "</td><td>",
           error(fitted.standard_error), "</td><td>", error(fitted.standard_error_clustered), "</td></tr>\n"},
          "");
    }
  }
  if (rows.empty()) return "";
  return Join({"<section><details><summary>Table of the parameters</summary>\n<table><thead><tr><th "
               "scope=\"col\">parameter</th><th scope=\"col\">value</th><th scope=\"col\">standard error</th><th "
               "scope=\"col\">clustered by incidence</th></tr></thead><tbody>\n",
               rows, "</tbody></table></details></section>\n"},
              "");
}

}  // namespace

std::string ReportHtml(const ReportData& data, const std::vector<Panel>& panels, const std::shared_ptr<Fonts>& fonts) {
  const Material& material = data.material;
  const std::string file = material.source.file.empty() ? data.measurement.source : material.source.file;
  const Badge badge = BadgeOf(material);
  const bool live = IsLive(material.model);
  std::string wide, narrow;
  const Contents contents = MakeContents(data, panels, live, fonts);
  for (const Figure& figure : contents.figures) (figure.wide ? wide : narrow) += FigureHtml(figure);
  return FillTemplate(kPageHtml,
                      {{"title", MarkupText(std::filesystem::path(file).filename().string())},
                       {"style", std::string(kPageCss)},
                       {"style-hash", PolicyHash(kPageCss)},
                       {"script", std::string(kPageJs)},
                       {"script-hash", PolicyHash(kPageJs)},
                       {"shader", Join({"#version 300 es\nprecision highp float;\nprecision highp int;\n",
                                        std::string(kLobeGlsl), std::string(kPageGlsl)},
                                       "")},
                       {"data", contents.data},
                       {"verdict", badge.words},
                       {"verdict-class", badge.mark == BadgeMark::kGood    ? ""
                                         : badge.mark == BadgeMark::kRough ? "rough"
                                                                           : "bad"},
                       {"model", MarkupText(ModelWords(material.model))},
                       {"parameters", ParameterTable(data)},
                       {"wide-figures", wide},
                       {"narrow-figures", narrow}},
                      {{"live", live}, {"still", !live}, {"instrument", data.reading.has_value()}});
}

}  // namespace lobefit
