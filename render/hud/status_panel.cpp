// One column, read from top to bottom: what is seen, whether it is live, how far the painting has come.
#include "render/hud/status_panel.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace orcart {
namespace {

constexpr Colour kGround{22, 24, 27, 255}, kLine{44, 48, 53, 255};
constexpr Colour kInk{236, 236, 232, 255}, kQuiet{148, 153, 160, 255}, kDark{16, 17, 19, 255};
constexpr Colour kGood{98, 200, 132, 255}, kWarn{244, 185, 66, 255}, kBad{238, 92, 82, 255},
    kCalm{110, 168, 224, 255};

struct StateWord {
  std::string_view word;
  Colour colour;
};

StateWord word_for(Freshness freshness) {
  switch (freshness) {
    case Freshness::live:
      return {"LIVE", kGood};
    case Freshness::stale:
      return {"STALE", kWarn};
    case Freshness::lost:
      break;
  }
  return {"LOST", kBad};
}

/// A short number with its unit, on the stack.
class Figure {
 public:
  Figure& whole(long value) {
    length_ = static_cast<std::size_t>(std::to_chars(at(), end(), value).ptr - text_.data());
    return *this;
  }
  Figure& tenths(double value) {
    const long scaled = std::lround(std::clamp(value, 0.0, 1e6) * 10);
    whole(scaled / 10).words(".");
    return whole(scaled % 10);
  }
  Figure& words(std::string_view text) {
    const std::size_t count = std::min(text.size(), text_.size() - length_);
    std::copy_n(text.data(), count, at());
    length_ += count;
    return *this;
  }
  std::string_view view() const { return {text_.data(), length_}; }

 private:
  char* at() { return text_.data() + length_; }
  char* end() { return text_.data() + text_.size(); }
  std::array<char, 80> text_{};
  std::size_t length_ = 0;
};

/// Goes down the column, line by line.
class Column {
 public:
  Column(HudCanvas& canvas, const PanelLayout& layout)
      : canvas_(canvas),
        unit_(canvas.scale()),
        left_(layout.column.x + 28 * unit_),
        right_(layout.column.x + layout.column.width - 28 * unit_),
        y_(layout.inset_centre.y + layout.inset_radius_px + 26 * unit_) {}

  void state(std::string_view what, Freshness freshness) {
    const StateWord state = word_for(freshness);
    y_ += 40 * unit_;
    const float middle = y_ - 0.5F * canvas_.font().cap_height_px(TextStyle::headline);
    canvas_.disc({left_ + 11 * unit_, middle}, 11 * unit_, state.colour);
    canvas_.text({left_ + 36 * unit_, y_}, TextStyle::headline, state.colour, state.word);
    canvas_.text_ending({right_, y_}, TextStyle::fine, kQuiet, what);
    y_ += 10 * unit_;
  }

  void pill(std::string_view text, Colour colour) {
    const float height = 36 * unit_;
    y_ += 8 * unit_;
    canvas_.box({left_, y_, right_ - left_, height}, 8 * unit_, colour);
    const float base = y_ + 0.5F * (height + canvas_.font().cap_height_px(TextStyle::strong));
    canvas_.text_centred({0.5F * (left_ + right_), base}, TextStyle::strong, kDark, text);
    y_ += height;
  }

  void rule() {
    y_ += 16 * unit_;
    canvas_.stroke({.from = {left_, y_}, .to = {right_, y_}, .width_px = std::max(1.0F, unit_)}, kLine);
  }

  void figure(std::string_view what, std::string_view value, Colour colour) {
    y_ += 33 * unit_;
    canvas_.text({left_, y_}, TextStyle::fine, kQuiet, what);
    canvas_.text_ending({right_, y_}, TextStyle::strong, colour, value);
  }

 private:
  HudCanvas& canvas_;
  float unit_, left_, right_, y_;
};

void draw_inset_frame(HudCanvas& canvas, const PanelLayout& layout, const Status& status,
                      InsetContent inset) {
  const float unit = canvas.scale();
  const float radius = layout.inset_radius_px;
  if (inset == InsetContent::blank) {
    canvas.disc(layout.inset_centre, radius, kDark);
    const float y = layout.inset_centre.y;
    canvas.text_centred({layout.inset_centre.x, y - 4 * unit}, TextStyle::strong, kBad, "NO LIVE");
    canvas.text_centred({layout.inset_centre.x, y + 28 * unit}, TextStyle::strong, kBad, "VIDEO");
  }
  const Colour state = inset == InsetContent::blank ? kBad : word_for(status.video).colour;
  canvas.ring(layout.inset_centre, radius + 4 * unit, 4 * unit, status.capture_acknowledged ? kInk : state);
  if (status.capture_acknowledged) canvas.ring(layout.inset_centre, radius + 10 * unit, 10 * unit, kInk);
}

void draw_column(HudCanvas& canvas, const PanelLayout& layout, const Status& status) {
  Column column(canvas, layout);
  column.state("video", status.video);
  column.state("tracker", status.tracker);
  if (!status.tool_seen) column.pill("TOOL NOT SEEN", kWarn);
  if (!status.reference_seen) column.pill("REFERENCE NOT SEEN", kWarn);
  if (status.degraded) column.pill("DEGRADED", kWarn);
  if (status.painting_blocked) column.pill("PAINTING BLOCKED", kWarn);
  column.rule();
  const Colour late = status.late_frames > 0 ? kWarn : kInk;
  column.figure("captures", Figure().whole(status.captures).view(), kInk);
  column.figure("surface painted", Figure().tenths(100.0 * status.coverage).words(" %").view(), kInk);
  column.figure("latency", Figure().tenths(status.latency_ms).words(" ms").view(), kInk);
  column.figure("late frames", Figure().whole(status.late_frames).view(), late);
}

/// As much of a text as is not wider than `widest_px`, whole letters.
std::string_view fitting(const Font& font, std::string_view text, float widest_px) {
  while (!text.empty() && font.width_px(TextStyle::banner, text) > widest_px) {
    bool inside_letter = true;
    while (inside_letter && !text.empty()) {
      inside_letter = (static_cast<unsigned char>(text.back()) & 0xC0) == 0x80;
      text.remove_suffix(1);
    }
  }
  return text;
}

/// A line of words in a box of its own, centred in the view, its top at y.
void draw_banner(HudCanvas& canvas, const HudBox& view, float y, Colour ground, std::string_view text) {
  const float unit = canvas.scale(), x = view.x + 0.5F * view.width, height = 56 * unit;
  text = fitting(canvas.font(), text, view.width - 80 * unit);
  const float width = canvas.font().width_px(TextStyle::banner, text) + 56 * unit;
  canvas.box({x - 0.5F * width, y, width, height}, 10 * unit, ground);
  const float base = y + 0.5F * (height + canvas.font().cap_height_px(TextStyle::banner));
  canvas.text_centred({x, base}, TextStyle::banner, kDark, text);
}

Colour ground_for(Notice::Level level) {
  if (level == Notice::Level::alarm) return kBad;
  return level == Notice::Level::warning ? kWarn : kCalm;
}

void put_speed(Figure& figure, const Status& status, int detail) {
  figure.whole(std::lround(status.rendered_hz)).words(" Hz");
  if (status.software_rendering && (detail == 3 || (detail > 0 && status.budget_misses == 0)))
    figure.words(", software");
  if (status.budget_misses == 0 || detail == 0) return;
  figure.words(", over budget ").whole(status.budget_misses);
  if (detail > 1) figure.words(", last ").words(status.missed_stage);
}

void draw_bar(HudCanvas& canvas, const HudBox& bar, const Status& status) {
  const float unit = canvas.scale();
  const float base = bar.y + 0.5F * (bar.height + canvas.font().cap_height_px(TextStyle::fine));
  const float left = bar.x + 24 * unit, right = bar.x + bar.width - 24 * unit;
  float x = left;
  if (status.simulated) x = canvas.text({x, base}, TextStyle::strong, kWarn, "SIMULATED");
  x = canvas.text(
      {x, base}, TextStyle::fine, kQuiet,
      status.simulated ? "  -  research use, not a medical device" : "research use, not a medical device");
  Figure figure;
  for (int detail = 3; detail >= 0; --detail) {  // the most that fits beside it
    figure = {};
    put_speed(figure, status, detail);
    if (canvas.font().width_px(TextStyle::fine, figure.view()) <= right - x - 16 * unit) break;
  }
  canvas.text_ending({right, base}, TextStyle::fine, status.budget_misses > 0 ? kWarn : kQuiet,
                     figure.view());
}

}  // namespace

PanelLayout panel_layout(int width_px, int height_px) noexcept {
  const auto width = static_cast<float>(width_px), height = static_cast<float>(height_px);
  const float unit = height / 800.0F;
  const float column = std::min(344 * unit, 0.45F * width), bar = 48 * unit;
  const float radius = 0.5F * column - 30 * unit;
  return {.view = {0, 0, width - column, height - bar},
          .column = {width - column, 0, column, height - bar},
          .inset_centre = {width - 0.5F * column, 30 * unit + radius},
          .inset_radius_px = radius,
          .bar = {0, height - bar, width, bar}};
}

void draw_column_and_bar(HudCanvas& canvas, const PanelLayout& layout, const Status& status,
                         InsetContent inset) noexcept {
  canvas.ground(layout.column, kGround);
  canvas.ground(layout.bar, kGround);
  const HudBox& bar = layout.bar;
  canvas.stroke({.from = {bar.x, bar.y}, .to = {bar.x + bar.width, bar.y}, .width_px = 1}, kLine);
  canvas.stroke({.from = {layout.column.x, 0}, .to = {layout.column.x, bar.y}, .width_px = 1}, kLine);
  draw_inset_frame(canvas, layout, status, inset);
  draw_column(canvas, layout, status);
  draw_bar(canvas, layout.bar, status);
  canvas.flush();
}

void draw_banners(HudCanvas& canvas, const PanelLayout& layout, const Status& status) noexcept {
  const HudBox& view = layout.view;
  const float unit = canvas.scale(), top = view.y + 24 * unit;
  if (status.capture_acknowledged) {
    draw_banner(canvas, view, top, kInk, "CAPTURE ACKNOWLEDGED");
  } else if (status.streaming) {
    draw_banner(canvas, view, top, kGood, "PAINTING WHILE THE PEDAL IS HELD");
  }
  if (status.notice.level == Notice::Level::none) return;
  const auto& text = status.notice.text;
  const auto length = static_cast<std::size_t>(std::find(text.begin(), text.end(), '\0') - text.begin());
  draw_banner(canvas, view, view.y + view.height - 80 * unit, ground_for(status.notice.level),
              {text.data(), length});
}

}  // namespace orcart
