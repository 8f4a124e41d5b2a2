#include "lobefit/report/web/html.h"
// The page: the panels as pictures, and the same data live.
#include <algorithm>
#include <cmath>
#include <memory>

#include "lobefit/base/base64.h"
#include "lobefit/base/text.h"
#include "lobefit/plot/png.h"
#include "lobefit/report/figures/page.h"
#include "lobefit/report/web/data.h"
#include "lobefit/report/web/text.h"

namespace lobefit {
namespace {

constexpr const char* kCss =
#include "lobefit/report/web/page.css.inc"
    ;
constexpr const char* kShader =
#include "lobefit/report/web/page.glsl.inc"
    ;
constexpr const char* kScript =
#include "lobefit/report/web/page.js.inc"
    ;

struct Figure {
  std::string id, description, png;
  bool wide = true;
};

// What stands in the picture, for those who do not see it: title and legend.
std::string Description(const Panel& panel) {
  std::vector<std::string> words;
  for (const LegendEntry& entry : panel.legend) words.push_back(entry.text);
  return words.empty() ? panel.title : Join({panel.title, ": ", Join(words, ", ")}, "");
}

std::vector<Figure> DrawFigures(const std::vector<Panel>& panels, const std::shared_ptr<Fonts>& fonts,
                                std::size_t most_bytes) {
  std::vector<Figure> figures;
  // Sharp on dense screens, unless the page would grow too large.
  for (const double scale : {1.5, 1.0}) {
    figures.clear();
    std::size_t bytes = 0;
    for (const Panel& panel : panels) {
      const Canvas canvas = DrawPanelAlone(panel, panel.wide ? 850 : 430, scale, fonts);
      figures.push_back({panel.id, Description(panel), EncodePng(canvas.pixels(), 0), panel.wide});
      bytes += figures.back().png.size();
    }
    if (bytes <= most_bytes) break;
  }
  return figures;
}

std::string FigureHtml(const Figure& figure) {
  return Join({"<figure id=\"", figure.id, "\"><img alt=\"", HtmlText(figure.description),
               "\" src=\"data:image/png;base64,", Base64(figure.png), "\"></figure>\n"},
              "");
}

// What the shader of the page evaluates; other models are shown in pictures only.
bool IsLive(const Model& model) {
  constexpr std::size_t kMostLobes = 8;  // of the shader
  return !model.lobes.empty() && model.lobes.size() <= kMostLobes &&
         std::all_of(model.lobes.begin(), model.lobes.end(), [](const Lobe& l) {
           return FamilyOf(l.ndf) == NdfFamily::kGgx || FamilyOf(l.ndf) == NdfFamily::kBeckmann;
         });
}

constexpr const char* kLive = R"(<div class="live">
<div>
<section id="sphereSection"><h2>Under a light</h2>
<canvas id="sphere" role="img" aria-label="Spheres of the material, measured and fitted, under one light."></canvas>
<div class="pair" id="names"><span>measured</span><span>fitted</span></div>
<div class="controls"><label for="lightX">light from left to right <input id="lightX" type="range" min="-120" max="120" step="1"></label><label for="lightY">from below to above <input id="lightY" type="range" min="-85" max="85" step="1"></label></div>
<p class="note">Drag on a sphere, or use the sliders, to move the light. Grey: no measured sample is near.</p></section>
<p id="noGl" class="note hidden">This browser offers no WebGL 2: the pictures below show the spheres, and parameters cannot be moved.</p>
<section id="sliceSection"><h2>Slice in the plane of incidence</h2>
<div class="controls"><label>polar angle <select id="theta"></select></label><label id="phiBox">azimuth <select id="phi"></select></label><button id="scale" type="button" aria-pressed="true">logarithmic scale</button></div>
<svg id="slice" viewBox="0 0 860 430" tabindex="0" role="img"></svg>
<div class="controls"><label for="point">measured value <input id="point" type="range" min="0" value="0" step="1"></label></div>
<div id="hover" role="status">Point at a measured value, or step through them with the slider.</div></section>
</div>
<div>
<section id="parameterSection"><h2>Parameters, live</h2>
<div id="sliders"></div>
<div class="controls"><button id="reset" type="button">Back to the fit</button></div>
<p class="note">Sliders move the sphere and the curve of the slice; the pictures below stay with the fit. Arrow keys step, with Shift finely.</p></section>
)";
constexpr const char* kLiveEnd = R"(</div>
</div>
)";

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
        return known ? JsonNumber(errors[c] * factor, 2) : fitted.free ? "not determined" : "fixed";
      };
      std::string name = parameter.json_name;
      if (parameter.per_channel && fitted.values.size() > 1) name += " " + data.channel_names[c];
      rows += Join(
          {"<tr><th scope=\"row\">", HtmlText(name), "</th><td>", JsonNumber(fitted.values[c] * factor, 6), "</td><td>",
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
  const std::string title = HtmlText(std::filesystem::path(file).filename().string());
  const bool good = material.termination.converged && material.termination.determined;
  const std::string verdict = !material.termination.converged ? "not converged"
                              : good                          ? "converged"
                                                              : "converged, not fully determined";
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'; script-src 'unsafe-inline'\">\n";
  html +=
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n";
  html += Join({"<title>", title, " – fit</title>\n<style>", kCss, "</style>\n</head>\n<body>\n", "<header><h1>", title,
                "</h1><span class=\"chip", good ? "" : " bad", "\">", verdict, "</span></header>\n",
                "<p class=\"sub\">", HtmlText(ModelWords(material.model)), "</p>\n"},
               "");
  const bool live = IsLive(material.model);
  html += "<main>\n";
  html += live ? kLive
               : "<p class=\"note\">This model is shown in pictures only; GGX and Beckmann lobes come with a live "
                 "sphere, slice and sliders.</p>\n";
  html += ParameterTable(data);
  if (live) html += kLiveEnd;
  html += R"(<h2>The fit</h2>
<div class="panels">
)";
  std::string wide, narrow;
  for (const Figure& figure : DrawFigures(panels, fonts, 1500000)) (figure.wide ? wide : narrow) += FigureHtml(figure);
  html += Join(
      {"<div class=\"stack\">\n", wide, "</div>\n<div class=\"stack\">\n", narrow, "</div>\n</div>\n</main>\n"}, "");
  if (!live) return html + "</body>\n</html>\n";
  html += Join({"<script id=\"data\" type=\"application/json\">", DataJson(data), "</script>\n",
                "<script id=\"shader\" type=\"text/plain\">", kShader, "</script>\n<script>", kScript,
                "</script>\n</body>\n</html>\n"},
               "");
  return html;
}

}  // namespace lobefit
