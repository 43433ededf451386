// Rasterises every letter of every style side by side on shelves, and keeps the pairs' kerning.
#include "render/hud/font.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <ft2build.h>
#include FT_FREETYPE_H

namespace orcart {
namespace {

struct Cut {
  const char* file;
  double size_px;
};

constexpr char kFolder[] = "/usr/share/fonts/truetype/dejavu/";
constexpr std::array<Cut, 4> kCuts{{{"DejaVuSans.ttf", 20},
                                    {"DejaVuSans-Bold.ttf", 22},
                                    {"DejaVuSans-Bold.ttf", 26},
                                    {"DejaVuSans-Bold.ttf", 38}}};

/// How many bytes follow a first byte of UTF-8; -1 where it can be none.
int bytes_that_follow(unsigned char first) {
  if (first < 0x80) return 0;
  if (first >= 0xC2 && first < 0xE0) return 1;
  if (first >= 0xE0 && first < 0xF0) return 2;
  if (first >= 0xF0 && first < 0xF5) return 3;
  return -1;
}

}  // namespace

char32_t take_code_point(std::string_view& utf8) noexcept {
  const auto first = static_cast<unsigned char>(utf8.front());
  utf8.remove_prefix(1);
  const int more = bytes_that_follow(first);
  if (more < 0) return 0xFFFD;
  char32_t code_point = more == 0 ? first : first & (0x3F >> more);
  for (int i = 0; i < more; ++i) {
    if (utf8.empty() || (static_cast<unsigned char>(utf8.front()) & 0xC0) != 0x80) return 0xFFFD;
    code_point = code_point << 6 | (static_cast<unsigned char>(utf8.front()) & 0x3F);
    utf8.remove_prefix(1);
  }
  return code_point;
}

/// Owns FreeType while the letters are being drawn.
class Font::Loader {
 public:
  explicit Loader(Font& font) : font_(font) {}
  ~Loader() {
    if (face_ != nullptr) FT_Done_Face(face_);
    if (library_ != nullptr) FT_Done_FreeType(library_);
  }
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;

  Result<void> load(const Cut& cut, double scale, Voice& voice) {
    const std::string path = std::string(kFolder) + cut.file;
    if (face_ != nullptr) FT_Done_Face(face_);
    face_ = nullptr;
    if (library_ == nullptr && FT_Init_FreeType(&library_) != 0) return fail("FreeType cannot be started");
    if (FT_New_Face(library_, path.c_str(), 0, &face_) != 0) {
      return fail(path + " cannot be read as a font; install fonts-dejavu-core");
    }
    FT_Set_Char_Size(face_, static_cast<FT_F26Dot6>(std::lround(cut.size_px * scale * 64)), 0, 72, 72);
    for (char32_t c = kFirst; c < kEnd; ++c) draw(c, voice.glyphs[c - kFirst]);
    for (char32_t left = kFirst; left < kAsciiEnd; ++left)
      for (char32_t right = kFirst; right < kAsciiEnd; ++right) keep_kerning(left, right, voice);
    return {};
  }

 private:
  void draw(char32_t code_point, Glyph& glyph) {
    if (FT_Load_Char(face_, code_point, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) return;
    const FT_GlyphSlot slot = face_->glyph;
    const FT_Bitmap& bitmap = slot->bitmap;
    glyph.advance_px = static_cast<float>(slot->linearHoriAdvance) / 65536.0F;
    glyph.left = static_cast<std::int16_t>(slot->bitmap_left);
    glyph.above = static_cast<std::int16_t>(slot->bitmap_top);
    glyph.width = static_cast<std::uint16_t>(bitmap.width);
    glyph.height = static_cast<std::uint16_t>(bitmap.rows);
    reserve(glyph);
    for (unsigned row = 0; row < bitmap.rows; ++row) {
      const unsigned char* from = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
      std::copy_n(from, bitmap.width, font_.coverage_.begin() + (glyph.y + row) * kAtlasWidth + glyph.x);
    }
  }

  /// One clear pixel between letters.
  void reserve(Glyph& glyph) {
    if (x_ + glyph.width + 1 > kAtlasWidth) {
      x_ = 0;
      y_ += shelf_;
      shelf_ = 0;
    }
    glyph.x = static_cast<std::uint16_t>(x_);
    glyph.y = static_cast<std::uint16_t>(y_);
    x_ += glyph.width + 1;
    shelf_ = std::max(shelf_, glyph.height + 1);
    font_.coverage_.resize(
        std::max(font_.coverage_.size(), static_cast<std::size_t>(y_ + shelf_) * kAtlasWidth), 0);
  }

  void keep_kerning(char32_t left, char32_t right, Voice& voice) {
    FT_Vector delta{};
    FT_Get_Kerning(face_, FT_Get_Char_Index(face_, left), FT_Get_Char_Index(face_, right),
                   FT_KERNING_UNFITTED, &delta);
    voice.kerning_64ths[(left - kFirst) * (kAsciiEnd - kFirst) + right - kFirst] =
        static_cast<std::int16_t>(delta.x);
  }

  Font& font_;
  FT_Library library_ = nullptr;
  FT_Face face_ = nullptr;
  int x_ = 0, y_ = 0, shelf_ = 0;
};

Result<Font> Font::create(double scale) {
  Font font;
  font.voices_.resize(kStyles);
  Loader loader(font);
  for (std::size_t i = 0; i < kStyles; ++i)
    if (auto loaded = loader.load(kCuts[i], scale, font.voices_[i]); !loaded)
      return tl::unexpected(loaded.error());
  return font;
}

const Glyph& Font::glyph(TextStyle style, char32_t code_point) const noexcept {
  const char32_t known = code_point >= kFirst && code_point < kEnd ? code_point : U'?';
  return voices_[static_cast<std::size_t>(style)].glyphs[known - kFirst];
}

float Font::kerning_px(TextStyle style, char32_t left, char32_t right) const noexcept {
  if (left < kFirst || left >= kAsciiEnd || right < kFirst || right >= kAsciiEnd) return 0;
  const auto& table = voices_[static_cast<std::size_t>(style)].kerning_64ths;
  return static_cast<float>(table[(left - kFirst) * (kAsciiEnd - kFirst) + right - kFirst]) / 64.0F;
}

float Font::width_px(TextStyle style, std::string_view utf8) const noexcept {
  float width = 0;
  char32_t before = 0;
  while (!utf8.empty()) {
    const char32_t c = take_code_point(utf8);
    width += kerning_px(style, before, c) + glyph(style, c).advance_px;
    before = c;
  }
  return width;
}

float Font::cap_height_px(TextStyle style) const noexcept {
  return glyph(style, U'H').above;
}

}  // namespace orcart
