// What a look at this machine found: what is there, what is lacking, and for each lack the one thing to do.
#pragma once

#include <string>
#include <vector>

namespace orcart {

/// One device or right. With a `lack`, `next` says what to do about it.
struct Finding {
  std::string area;  ///< tracker, camera, pedal, encoder, panel or system
  std::string name;
  std::vector<std::string> details{};
  std::string lack{};
  std::string next{};
};

struct ProbeReport {
  std::vector<Finding> findings;
  std::size_t lacks() const;
};

/// For a person: what is there by area, then the lacks with their remedies, numbered.
std::string text_of(const ProbeReport& report);
/// {"lacks": n, "findings": [{"area", "name", "details": [], "lack", "next"}]}
std::string json_of(const ProbeReport& report);

}  // namespace orcart
