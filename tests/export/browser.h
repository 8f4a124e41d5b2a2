// Shader text compiled by glslangValidator and run in WebGL 2 by headless Chromium, for tests that skip where these are
// not installed.
#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"
#include "lobefit/math/vec.h"

namespace lobefit::test {

inline bool Installed(const char* program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

inline std::string OutputOf(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text.push_back(static_cast<char>(c));
  pclose(pipe);
  return text;
}

inline std::string Validate(const std::string& text, const std::filesystem::path& folder) {
  WriteFileAtomically(folder / "shader.frag", text);
  return OutputOf("glslangValidator '" + (folder / "shader.frag").string() + "' 2>&1");
}

struct Texel {
  Vec3 xyz;
  double w;
};

// Each text defines `vec3 pixel(vec4 a, vec4 b)`, which is asked with each pair of texels in floating point. Four
// numbers a pair, one row a text; fails the test where the page gives no such rows.
inline std::vector<std::vector<double>> EvaluateInBrowser(const std::vector<std::string>& texts,
                                                          const std::vector<std::array<Texel, 2>>& pairs,
                                                          const std::filesystem::path& folder) {
  std::string data;
  for (const std::array<Texel, 2>& pair : pairs) {
    for (const Texel& t : pair) data += fmt::format("{},{},{},{},", t.xyz.x, t.xyz.y, t.xyz.z, t.w);
  }
  const std::string head =
      "#version 300 es\nprecision highp float;\nprecision highp sampler2D;\nuniform sampler2D pairs;\nout vec4 c;\n";
  const std::string main =
      "void main() { int k = int(gl_FragCoord.x); c = vec4(pixel(texelFetch(pairs, ivec2(2 * k, 0), 0), "
      "texelFetch(pairs, ivec2(2 * k + 1, 0), 0)), 1.0); }\n";
  std::string page = "<pre id=\"result\"></pre>";
  for (const std::string& text : texts) {
    page += "<script type=\"text/plain\" class=\"shader\">" + head + text + main + "</script>";
  }
  page += "<script>const pairs = new Float32Array([" + data + "]);\n";
  page += R"(const gl = document.createElement('canvas').getContext('webgl2');
gl.getExtension('EXT_color_buffer_float');
const texture = (w, data) => { const t = gl.createTexture(); gl.bindTexture(gl.TEXTURE_2D, t);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, w, 1, 0, gl.RGBA, gl.FLOAT, data);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST); gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST); return t; };
const n = pairs.length / 8, target = texture(n, null);
gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
texture(2 * n, pairs); gl.viewport(0, 0, n, 1);
let out = '';
for (const element of document.querySelectorAll('.shader')) {
  const p = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, '#version 300 es\nvoid main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }'], [gl.FRAGMENT_SHADER, element.textContent]]) {
    const s = gl.createShader(type); gl.shaderSource(s, source); gl.compileShader(s); out += gl.getShaderInfoLog(s) || ''; gl.attachShader(p, s); }
  gl.linkProgram(p); gl.useProgram(p); gl.drawArrays(gl.TRIANGLES, 0, 3);
  const pixels = new Float32Array(4 * n); gl.readPixels(0, 0, n, 1, gl.RGBA, gl.FLOAT, pixels);
  out += Array.from(pixels).join(' ') + '\n'; }
document.getElementById('result').textContent = out;
</script>)";
  WriteFileAtomically(folder / "page.html", page);
  const std::string dom = OutputOf(
      "timeout 300 chromium --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
      "--disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync "
      "--virtual-time-budget=10000 --user-data-dir='" +
      (folder / "profile").string() + "' --dump-dom 'file://" + (folder / "page.html").string() + "' 2>/dev/null");
  const std::size_t begin = dom.find("<pre id=\"result\">") + 17;
  const std::string result = dom.substr(begin, dom.find("</pre>", begin) - begin);
  std::vector<std::vector<double>> rows;
  LineReader lines(result);
  std::string_view line;
  while (lines.Next(&line)) {
    rows.emplace_back();
    for (const std::string_view value : SplitBlanks(line)) {
      const std::optional<double> number = ParseDouble(value);
      if (!number) ADD_FAILURE() << "the page says: " << result.substr(0, 2000);
      if (!number) return rows;
      rows.back().push_back(*number);
    }
  }
  return rows;
}

}  // namespace lobefit::test
