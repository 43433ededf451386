// Words for a person, and the same as JSON.
#include "tools/probe/findings.hpp"

#include <algorithm>
#include <cstdio>

namespace orcart {
namespace {

/// A JSON string; bytes that a device's name should not have come out escaped.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char letter : text) {
    const auto byte = static_cast<unsigned char>(letter);
    if (letter == '"' || letter == '\\') {
      out += '\\';
      out += letter;
    } else if (byte < 0x20 || byte == 0x7F) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", byte);
      out += escape;
    } else {
      out += letter;
    }
  }
  return out + '"';
}

std::string padded(const std::string& area) {
  return area + std::string(area.size() < 9 ? 9 - area.size() : 1, ' ');
}

}  // namespace

std::size_t ProbeReport::lacks() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(findings, [](const Finding& f) { return !f.lack.empty(); }));
}

std::string text_of(const ProbeReport& report) {
  std::string text;
  for (const Finding& finding : report.findings) {
    if (finding.name.empty()) continue;
    text += padded(finding.area) + finding.name + "\n";
    for (const std::string& detail : finding.details) text += padded("") + "  " + detail + "\n";
  }
  if (report.lacks() == 0) return text + "nothing is lacking\n";
  text += "lacking:\n";
  int number = 0;
  for (const Finding& finding : report.findings) {
    if (finding.lack.empty()) continue;
    text += "  " + std::to_string(++number) + ". " + finding.area + ": " + finding.lack +
            "\n     do: " + finding.next + "\n";
  }
  return text;
}

std::string json_of(const ProbeReport& report) {
  std::string json = "{\"lacks\": " + std::to_string(report.lacks()) + ", \"findings\": [";
  for (std::size_t i = 0; i < report.findings.size(); ++i) {
    const Finding& f = report.findings[i];
    json += std::string(i == 0 ? "" : ", ") + "{\"area\": " + quoted(f.area) +
            ", \"name\": " + quoted(f.name) + ", \"details\": [";
    for (std::size_t d = 0; d < f.details.size(); ++d) json += (d == 0 ? "" : ", ") + quoted(f.details[d]);
    json += "], \"lack\": " + quoted(f.lack) + ", \"next\": " + quoted(f.next) + "}";
  }
  return json + "]}\n";
}

}  // namespace orcart
