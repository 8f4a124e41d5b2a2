#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <mutex>
#include <tuple>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include <opencv2/imgproc.hpp>

#include "lobefit/plot/canvas.h"

namespace lobefit {
namespace {

constexpr std::array<const char*, 4> kFolders = {"/usr/share/fonts/truetype/dejavu",
                                                 "/usr/share/fonts/dejavu-sans-fonts", "/usr/share/fonts/TTF",
                                                 "/usr/local/share/fonts"};

// What the stroke font, which is ASCII, shows in place of the characters that reports use.
std::string Spelled(char32_t character) {
  static const std::map<char32_t, std::string> spelled = {
      {U'θ', "theta"}, {U'φ', "phi"}, {U'α', "alpha"}, {U'λ', "lambda"}, {U'π', "pi"}, {U'σ', "sigma"},
      {U'ρ', "rho"},   {U'·', "."},   {U'±', "+-"},    {U'−', "-"},      {U'×', "x"},  {U'°', " deg"},
      {U'…', "..."},   {U'–', "-"},   {U'≤', "<="},    {U'≥', ">="}};
  const auto found = spelled.find(character);
  if (found != spelled.end()) return found->second;
  return character < 128 ? std::string(1, static_cast<char>(character)) : "?";
}

}  // namespace

struct Fonts::State {
  FT_Library library = nullptr;
  std::array<FT_Face, 3> faces = {};  // regular, bold, mono
  std::mutex mutex;                   // of the glyphs, and of the faces that draw them
  std::map<std::tuple<char32_t, int, Weight>, Glyph> glyphs;

  FT_Face FaceOf(Weight weight) const {
    if (weight == Weight::kBold && faces[1] != nullptr) return faces[1];
    if (weight == Weight::kMono && faces[2] != nullptr) return faces[2];
    return faces[0];
  }
  Glyph Render(char32_t character, double pixels, Weight weight) const;
};

Fonts::Fonts(const std::vector<std::string>& folders) : state_(std::make_unique<State>()) {
  if (FT_Init_FreeType(&state_->library) != 0) {
    state_->library = nullptr;
    return;
  }
  std::vector<std::string> places = folders;
  if (places.empty()) places.assign(kFolders.begin(), kFolders.end());
  const std::array<const char*, 3> files = {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf", "DejaVuSansMono.ttf"};
  for (const std::string& folder : places) {
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::string path = folder + "/" + files[i];
      std::error_code ignored;
      if (state_->faces[i] != nullptr || !std::filesystem::exists(path, ignored)) continue;
      if (FT_New_Face(state_->library, path.c_str(), 0, &state_->faces[i]) != 0) state_->faces[i] = nullptr;
    }
  }
}

Fonts::~Fonts() {
  if (state_->library != nullptr) FT_Done_FreeType(state_->library);  // frees the faces too
}

bool Fonts::has_outlines() const { return state_->faces[0] != nullptr; }

Fonts::Glyph Fonts::State::Render(char32_t character, double pixels, Weight weight) const {
  Glyph glyph;
  FT_FaceRec* const face = FaceOf(weight);
  if (face == nullptr) {
    const std::string text = Spelled(character);
    const double font_scale = pixels / 30;
    const int thickness = std::max(1, static_cast<int>(std::lround(pixels / (weight == Weight::kBold ? 11 : 18))));
    int below = 0;
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font_scale, thickness, &below);
    below += thickness + 2;
    glyph.coverage = cv::Mat::zeros(size.height + below + thickness, size.width + thickness, CV_8U);
    cv::putText(glyph.coverage, text, {0, size.height}, cv::FONT_HERSHEY_SIMPLEX, font_scale, 255, thickness,
                cv::LINE_AA);
    glyph.top = size.height;
    glyph.advance = size.width;
    return glyph;
  }
  FT_Set_Char_Size(face, 0, static_cast<FT_F26Dot6>(std::lround(pixels * 64)), 72, 72);
  if (FT_Load_Char(face, character, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP) != 0) return glyph;
  FT_GlyphSlotRec* const slot = face->glyph;
  if (weight == Weight::kOblique) {
    const FT_Matrix slant = {0x10000, 0x10000 / 5, 0, 0x10000};
    FT_Outline_Transform(&slot->outline, &slant);
  }
  glyph.advance = static_cast<double>(slot->linearHoriAdvance) / 65536;
  if (FT_Render_Glyph(slot, FT_RENDER_MODE_NORMAL) != 0) return glyph;
  const FT_Bitmap& bitmap = slot->bitmap;
  if (bitmap.rows > 0 && bitmap.width > 0) {
    const cv::Mat view(static_cast<int>(bitmap.rows), static_cast<int>(bitmap.width), CV_8U, bitmap.buffer,
                       static_cast<std::size_t>(std::abs(bitmap.pitch)));
    glyph.coverage = view.clone();
  }
  glyph.left = slot->bitmap_left;
  glyph.top = slot->bitmap_top;
  return glyph;
}

const Fonts::Glyph& Fonts::Find(char32_t character, double pixels, Weight weight) {
  const auto key = std::make_tuple(character, static_cast<int>(std::lround(pixels * 64)), weight);
  const std::lock_guard<std::mutex> lock(state_->mutex);
  const auto found = state_->glyphs.find(key);
  if (found != state_->glyphs.end()) return found->second;
  return state_->glyphs.emplace(key, state_->Render(character, pixels, weight)).first->second;
}

}  // namespace lobefit
