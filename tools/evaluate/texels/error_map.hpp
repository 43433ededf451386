// What `orcart evaluate map` does: paints recorded views, predicts each painted texel's error, checks it by
// draws, and writes it as colours.
#pragma once

#include <filesystem>

#include "tools/evaluate/evaluate_command.hpp"
#include "tools/evaluate/texels/texel_errors.hpp"

namespace orcart {

struct ErrorMapCommand {
  std::filesystem::path surface, scope, registration, scope_rom, reference_rom, views;
  std::filesystem::path out;  ///< .obj, .ply or .glb: the surface; .png: what the last view sees
  SeenFrom seen_from = SeenFrom::inside;
  ErrorModel model;
  double texel_mm = 0.3;
  int setups = 200;  ///< draws that the prediction is checked by
  std::uint64_t seed = 1;
};

struct ErrorMapReport {
  static constexpr double kDarkest_mm = 2;  ///< and beyond: violet; 0 is yellow
  ErrorModel model;                         ///< with what passport and registration state
  std::filesystem::path out;
  std::size_t views = 0, texels = 0;
  ViewVelocities velocities;          ///< of the views, which the time's error is multiplied by
  double texel_mm = 0, coverage = 0;  ///< of the surface, 0..1
  Statistics rms_mm;                  ///< over the painted texels
  int setups = 0;
  DrawnCoverage drawn;
  double seconds = 0;
};

/// Makes an OpenGL context of its own. Nothing is written where anything fails.
Result<ErrorMapReport> make_error_map(const ErrorMapCommand& command, const EvaluateProgress& progress);

std::string text_of(const ErrorMapReport& report);
std::string json_of(const ErrorMapReport& report);

}  // namespace orcart
