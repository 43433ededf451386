// Writes small enhanced multi-frame CT files, byte by byte, for the tests of the reader.
#pragma once

#include <functional>
#include <optional>

#include "tests/tools/volume/dicom_sample.hpp"

namespace orcart {

struct EnhancedFrame {
  std::string position = "0\\0\\0", slope = "2", intercept = "-1000";
  std::int16_t first = 0;            ///< pixel values count up from it
  std::string type, stack, spacing;  ///< spacing: of this frame, not the shared one
  std::optional<double> echo_ms, delay_ms;
  std::uint16_t acquisition = 0;
};

struct EnhancedSample : DicomBytes {
  std::vector<EnhancedFrame> frames;
  std::string instance = "1.2.9", series = "1.2.3", orientation = "1\\0\\0\\0\\1\\0", spacing = "0.75\\0.5",
              stated_frames, concatenation;
  std::uint16_t rows = 3, columns = 4;
  bool open_ended_groups = false, run_length = false;
  std::size_t frames_of_pixels = 1000;  ///< at most so many

  std::string bytes() const {
    const std::size_t count = std::min(frames.size(), frames_of_pixels);
    std::string set = text(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2.1") + text(8, 0x18, "UI", instance) +
                      text(8, 0x60, "CS", "CT") + text(0x10, 0x20, "LO", "P1") +
                      text(0x20, 0x0E, "UI", series) + text(0x20, 0x52, "UI", "1.2.3.4");
    if (!concatenation.empty()) set += text(0x20, 0x9161, "UI", concatenation);
    set += short_number(0x28, 2, 1) + text(0x28, 4, "CS", "MONOCHROME2") +
           text(0x28, 8, "IS", stated_frames.empty() ? std::to_string(frames.size()) : stated_frames) +
           short_number(0x28, 0x10, rows) + short_number(0x28, 0x11, columns) +
           short_number(0x28, 0x100, 16) + short_number(0x28, 0x101, 16) + short_number(0x28, 0x102, 15) +
           short_number(0x28, 0x103, 1);
    std::string shared = group(0x20, 0x9116, text(0x20, 0x37, "DS", orientation));
    if (!spacing.empty()) shared += group(0x28, 0x9110, text(0x28, 0x30, "DS", spacing));
    std::string own, pixels;
    for (const EnhancedFrame& frame : frames) own += item(groups_of(frame));
    set += sequence(0x5200, 0x9229, item(shared)) + sequence(0x5200, 0x9230, own);
    for (std::size_t i = 0; i < count; ++i)
      pixels += run_length ? item(packed(pixels_of(frames[i]))) : pixels_of(frames[i]);
    if (!run_length) return file("1.2.840.10008.1.2.1", set + wide(0x7fe0, 0x10, "OW", pixels));
    return file("1.2.840.10008.1.2.5", set + open_ended(0x7fe0, 0x10, "OB", item("") + pixels));
  }

 private:
  std::string sequence(std::uint16_t group, std::uint16_t element, const std::string& items) const {
    return open_ended_groups ? open_ended(group, element, "SQ", items) : wide(group, element, "SQ", items);
  }
  std::string group(std::uint16_t group, std::uint16_t element, const std::string& content) const {
    return sequence(group, element, item(content));
  }

  std::string groups_of(const EnhancedFrame& frame) const {
    std::string own;
    if (frame.echo_ms) own += group(0x18, 0x9114, real(0x18, 0x9082, *frame.echo_ms));
    if (frame.delay_ms) own += group(0x18, 0x9118, real(0x20, 0x9153, *frame.delay_ms));
    if (!frame.type.empty()) own += group(0x18, 0x9329, text(8, 0x9007, "CS", frame.type));
    own += group(0x20, 0x9111,
                 text(0x20, 0x9056, "SH", frame.stack) + short_number(0x20, 0x9156, frame.acquisition));
    if (!frame.position.empty()) own += group(0x20, 0x9113, text(0x20, 0x32, "DS", frame.position));
    if (!frame.spacing.empty()) own += group(0x28, 0x9110, text(0x28, 0x30, "DS", frame.spacing));
    return own + group(0x28, 0x9145,
                       text(0x28, 0x1052, "DS", frame.intercept) + text(0x28, 0x1053, "DS", frame.slope));
  }

  std::string pixels_of(const EnhancedFrame& frame) const {
    std::string pixels;
    for (int i = 0; i < rows * columns; ++i) pixels += little(static_cast<std::uint16_t>(frame.first + i));
    return pixels;
  }

  /// DICOM's run lengths (PS3.5, annex G) with literal runs only: the high bytes, then the low ones.
  static std::string packed(const std::string& pixels) {
    std::string halves[2];
    for (std::size_t i = 0; i < pixels.size(); ++i) halves[1 - i % 2] += pixels[i];
    for (std::string& half : halves) half.insert(0, 1, static_cast<char>(half.size() - 1));
    for (std::string& half : halves) half.append(half.size() % 2, '\0');
    std::string head =
        long_number(2) + long_number(64) + long_number(64 + static_cast<std::uint32_t>(halves[0].size()));
    head.resize(64);
    return head + halves[0] + halves[1];
  }
};

/// The volume that write_series writes, as one file.
inline EnhancedSample enhanced_series(int count) {
  EnhancedSample sample;
  for (int i = 0; i < count; ++i)
    sample.frames.push_back(
        {.position = "-10\\-20\\" + std::to_string(2 * i), .first = static_cast<std::int16_t>(100 * i)});
  return sample;
}

}  // namespace orcart
