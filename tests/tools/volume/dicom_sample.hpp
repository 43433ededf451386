// Writes small DICOM files, explicit little endian, byte by byte, for the tests of the reader.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {

/// Elements as bytes.
struct DicomBytes {
  static std::string little(std::uint16_t value) {
    return {static_cast<char>(value & 0xFFU), static_cast<char>(value >> 8U)};
  }
  static std::string long_number(std::uint32_t value) {
    return little(static_cast<std::uint16_t>(value & 0xFFFFU)) +
           little(static_cast<std::uint16_t>(value >> 16U));
  }
  static std::string tag(std::uint16_t group, std::uint16_t element) {
    return little(group) + little(element);
  }
  static std::string number(std::uint16_t group, std::uint16_t element, const char* kind,
                            const std::string& value) {
    return tag(group, element) + kind + little(static_cast<std::uint16_t>(value.size())) + value;
  }
  static std::string text(std::uint16_t group, std::uint16_t element, const std::string& kind,
                          std::string value) {
    if (value.size() % 2 == 1) value += kind == "UI" ? '\0' : ' ';
    return number(group, element, kind.c_str(), value);
  }
  static std::string short_number(std::uint16_t group, std::uint16_t element, std::uint16_t value) {
    return number(group, element, "US", little(value));
  }
  static std::string real(std::uint16_t group, std::uint16_t element, double value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return number(group, element, "FD", bytes);
  }
  static std::string wide(std::uint16_t group, std::uint16_t element, const char* kind,
                          const std::string& value) {
    return tag(group, element) + kind + std::string(2, '\0') +
           long_number(static_cast<std::uint32_t>(value.size())) + value;
  }
  static std::string item(const std::string& value) {
    return tag(0xFFFE, 0xE000) + long_number(static_cast<std::uint32_t>(value.size())) + value;
  }
  static std::string open_ended(std::uint16_t group, std::uint16_t element, const char* kind,
                                const std::string& items) {
    return tag(group, element) + kind + std::string(2, '\0') + long_number(0xFFFFFFFFU) + items +
           tag(0xFFFE, 0xE0DD) + long_number(0);
  }
  static std::string file(const std::string& transfer_syntax, const std::string& set) {
    const std::string meta = text(2, 0x10, "UI", transfer_syntax);
    return std::string(128, '\0') + "DICM" +
           number(2, 0, "UL", long_number(static_cast<std::uint32_t>(meta.size()))) + meta + set;
  }
};

struct DicomSample : DicomBytes {
  std::string patient = "P1", series = "1.2.3", position = "0\\0\\0", orientation = "1\\0\\0\\0\\1\\0",
              slope = "2", intercept = "-1000", transfer_syntax = "1.2.840.10008.1.2.1", frames, type;
  std::uint16_t rows = 3, columns = 4, samples = 1;
  std::int16_t first = 0;  ///< pixel values count up from it

  std::string bytes() const {
    std::string set;
    if (!type.empty()) set += text(8, 8, "CS", type);
    set += text(8, 0x16, "UI", "1.2.840.10008.5.1.4.1.1.2") +
           text(8, 0x18, "UI", "1.2.3." + position + type) + text(8, 0x60, "CS", "CT") +
           text(0x10, 0x20, "LO", patient) + text(0x20, 0x0E, "UI", series) +
           text(0x20, 0x32, "DS", position) + text(0x20, 0x37, "DS", orientation) +
           text(0x20, 0x52, "UI", "1.2.3.4") + short_number(0x28, 2, samples) +
           text(0x28, 4, "CS", "MONOCHROME2");
    if (!frames.empty()) set += text(0x28, 8, "IS", frames);
    set += short_number(0x28, 0x10, rows) + short_number(0x28, 0x11, columns) +
           text(0x28, 0x30, "DS", "0.75\\0.5") + short_number(0x28, 0x100, 16) +
           short_number(0x28, 0x101, 16) + short_number(0x28, 0x102, 15) + short_number(0x28, 0x103, 1) +
           text(0x28, 0x1052, "DS", intercept) + text(0x28, 0x1053, "DS", slope);
    std::string pixels;
    for (int i = 0; i < rows * columns * samples; ++i)
      pixels += little(static_cast<std::uint16_t>(first + i));
    return file(transfer_syntax, set + wide(0x7fe0, 0x10, "OW", pixels));
  }
};

/// Slices 2 mm apart, their names in the opposite order of their heights.
inline void write_series(const TemporaryFolder& folder, int count, const DicomSample& like = {}) {
  for (int i = 0; i < count; ++i) {
    DicomSample one = like;
    one.position = "-10\\-20\\" + std::to_string(2 * i);
    one.first = static_cast<std::int16_t>(100 * i);
    folder.write(std::to_string(900 - i), one.bytes());
  }
}

}  // namespace orcart
