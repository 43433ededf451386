// The panel's letters: DejaVu Sans through FreeType, rasterised once into one grey picture. No GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart {

/// Four voices are enough for a calm panel. Sizes are pixels of the em square at scale 1, for a panel 800 px
/// high.
enum class TextStyle : std::uint8_t {
  fine,      ///< 20 px
  strong,    ///< 22 px, bold
  banner,    ///< 26 px, bold
  headline,  ///< 38 px, bold
};

/// One letter: where it lies in the picture and how it stands on the base line. Pixels.
struct Glyph {
  std::uint16_t x = 0, y = 0, width = 0, height = 0;
  std::int16_t left = 0;   ///< from the pen to the left edge
  std::int16_t above = 0;  ///< from the base line up to the top edge
  float advance_px = 0;
};

/// The next code point of a UTF-8 text, whose bytes are taken off its front; U+FFFD where the bytes are not
/// UTF-8. The text must not be empty. Allocates nothing.
char32_t take_code_point(std::string_view& utf8) noexcept;

/// Immutable after create(); lookups allocate nothing. Latin-1 and Latin Extended-A; others show as '?'.
class Font {
 public:
  /// `scale` multiplies the sizes of TextStyle. Reads the files of Debian's fonts-dejavu-core.
  static Result<Font> create(double scale);

  const Glyph& glyph(TextStyle style, char32_t code_point) const noexcept;
  /// What to add to the pen between two letters; 0 outside ASCII.
  float kerning_px(TextStyle style, char32_t left, char32_t right) const noexcept;
  /// Length of a line of text.
  float width_px(TextStyle style, std::string_view utf8) const noexcept;
  /// Height of a capital letter: what a line is centred by.
  float cap_height_px(TextStyle style) const noexcept;

  int atlas_width_px() const noexcept { return kAtlasWidth; }
  int atlas_height_px() const noexcept { return static_cast<int>(coverage_.size()) / kAtlasWidth; }
  const std::vector<std::uint8_t>& coverage() const noexcept { return coverage_; }  ///< row by row, 255: ink

 private:
  static constexpr int kAtlasWidth = 1024;
  static constexpr char32_t kFirst = 0x20, kEnd = 0x180, kAsciiEnd = 0x7F;
  static constexpr std::size_t kStyles = 4;
  struct Voice {
    std::array<Glyph, kEnd - kFirst> glyphs{};
    std::array<std::int16_t, (kAsciiEnd - kFirst) * (kAsciiEnd - kFirst)> kerning_64ths{};
  };
  class Loader;

  std::vector<Voice> voices_;
  std::vector<std::uint8_t> coverage_;
};

}  // namespace orcart
