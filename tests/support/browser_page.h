// A page in headless Chromium, which tells what it is in <pre id="result">.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <string>

#include "lobefit/base/files/file.h"
#include "lobefit/base/text/text.h"

namespace lobefit::test {

inline std::string OutputOf(const std::string& command) {
  std::string out;
  std::FILE* pipe = popen(command.c_str(), "r");
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) out.push_back(static_cast<char>(c));
  pclose(pipe);
  return out;
}

// The result of the page, or "" without a browser. `script` stands before the page's policy, which is left as it is.
// Files beside `stem` are made and removed.
inline std::string VisitPage(std::string html, const std::string& script, const std::filesystem::path& stem,
                             const std::string& flags = "") {
  if (std::system("command -v chromium >/dev/null 2>&1") != 0) return "";
  const std::string mark = "<meta charset=\"utf-8\">\n";
  html.insert(html.find(mark) + mark.size(), "<script>" + script + "</script>\n");
  const std::filesystem::path page = stem.string() + ".test.html", profile = stem.string() + ".profile";
  WriteFileAtomically(page, html);
  const std::string dom = OutputOf(
      Join({"timeout 300 chromium --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader",
            "--disable-quic --no-first-run --disable-background-networking --disable-component-update --disable-sync",
            "--window-size=500,900 --virtual-time-budget=10000 --user-data-dir='" + profile.string() + "'", flags,
            "--dump-dom 'file://" + page.string() + "' 2>/dev/null"},
           " "));
  std::error_code ignored;
  std::filesystem::remove_all(profile, ignored);
  std::filesystem::remove(page, ignored);
  const std::string result_mark = "<pre id=\"result\">";
  const std::size_t begin = dom.find(result_mark);
  return begin == std::string::npos
             ? "no result"
             : dom.substr(begin + result_mark.size(), dom.find("</pre>", begin) - begin - result_mark.size());
}

inline double NumberAfter(const std::string& json, const std::string& key) {
  std::smatch match;
  if (!std::regex_search(json, match, std::regex("\"" + key + "\":([-+.0-9eE]+)"))) return std::nan("");
  return ParseDouble(match[1].str()).value_or(std::nan(""));
}

}  // namespace lobefit::test
