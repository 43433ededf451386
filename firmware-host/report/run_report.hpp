// What a run was like, in figures: gathered by the app after the threads have stopped, written as a page and
// as JSON.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "realtime/base/result.hpp"

namespace orcart {

/// A distribution of times on logarithmic bins, with the budget it is judged by. Milliseconds.
struct Distribution {
  std::string name;
  std::string note;      ///< where it is measured, in a few words
  double budget_ms = 0;  ///< at the percentile that the number of samples supports
  double bound_ms = 0;
  std::uint64_t samples = 0;
  double p50_ms = 0;
  double judged_quantile = 0;  ///< highest of 0.5, 0.9, 0.99, 0.999 that the samples support
  double judged_ms = 0;        ///< the value at that percentile
  double max_ms = 0;
  std::uint64_t over_bound = 0;
  std::vector<std::uint64_t> bins;  ///< kDistributionBins counts
  bool within_budget() const { return samples == 0 || judged_ms <= budget_ms; }
};

/// Bins: logarithmic from 1 us to 1 s.
inline constexpr int kDistributionBins = 90;
int distribution_bin(double ms);
double bin_lower_ms(int bin);

/// Sorts a copy of the samples and fills everything but name, note and budgets.
void fill_from_samples(Distribution& distribution, std::vector<double> samples_ms);

struct CaptureRow {
  std::uint32_t unit = 0;
  std::string outcome;  ///< "painted", "undone", or why it was refused
  double edge_s = 0;    ///< since the run began
  double to_acknowledged_ms = -1,
         to_painted_ms = -1;  ///< until the scan-out that shows it; negative: did not
  double pose_distance_ms = -1;
  std::string pose;
};

/// Where painted light lies against where it came from, mm. Only in simulation, where the truth is known.
struct PaintingError {
  std::string name;  ///< e.g. "perspective, tracker noise 0.05 mm"
  std::uint64_t texels = 0;
  double mean_mm = 0, p95_mm = 0, max_mm = 0;
  std::vector<std::uint64_t> bins;  ///< of 0.02 mm, the last one holds the rest
};
inline constexpr double kErrorBinMm = 0.02;

struct CoveragePoint {
  double at_s = 0;
  double covered = 0;
};

struct RunReport {
  std::string title, cart, when, machine, renderer, render_class;
  bool pictures_by_gpu = false;  ///< the GPU took the camera's pictures from its dma-bufs, to the end
  bool simulated = false;
  double duration_s = 0;
  double panel_hz = 0, camera_hz = 0, tracker_hz = 0;
  std::uint32_t triangles = 0;
  double texel_mm = 0;
  std::uint64_t frames_shown = 0, frames_late = 0, frames_dropped = 0, sequence_gaps = 0;
  std::uint64_t tracker_polls = 0, tracker_missing = 0, tracker_bad_crc = 0;
  std::uint64_t queue_drops = 0;
  double resident_mb = 0;
  double coverage = 0;
  std::string painting_hash;
  std::vector<std::string> degraded;  ///< each a sentence with its remedy
  std::vector<std::string> events;    ///< what was dropped, late or refused, and why
  std::vector<Distribution> stages, wake_ups, paths;
  std::vector<CaptureRow> captures;
  std::vector<CoveragePoint> coverage_over_time;
  std::vector<PaintingError> errors;
  std::vector<std::string> pictures;  ///< file names beside the report, in the order they are shown
};

/// Writes DIR/report.html (pictures linked beside it) and DIR/report.json. Never half a file.
Result<void> write_report(const std::filesystem::path& dir, const RunReport& report);

/// The ten lines a person reads at the end.
std::string summary_of(const RunReport& report, const std::filesystem::path& dir);

}  // namespace orcart
