// Draws a procedure's pictures before it runs, on all cores, unless the same movie lies there already.
#pragma once

#include <filesystem>
#include <functional>

#include "board/sim/movie_file.hpp"
#include "board/sim/scope_camera.hpp"
#include "board/sim/simulated_world.hpp"

namespace orcart {

/// What a movie is drawn from; everything is borrowed for the call.
struct MovieRequest {
  const Surface& surface;
  const RayScene& rays;
  const ScopeModel& scope;
  const SimulatedWorld& world;
  SceneLook look{};
  PixelFormat format = PixelFormat::yuyv;
  ExposureTiming timing{};
  int threads = 0;  ///< 0: one per core
};

/// The header of the movie that a request would draw: as many frames as end within the procedure.
MovieHeader header_for(const MovieRequest& request);

/// Called now and then, from the calling thread, with the frames drawn so far.
using DrawingProgress = std::function<void(std::uint64_t drawn, std::uint64_t all)>;

/// Opens `file` where its header matches; draws it otherwise. Allocates and blocks: before arming only.
Result<MovieFile> movie_for(const std::filesystem::path& file, const MovieRequest& request,
                            const DrawingProgress& progress = {});

/// One picture of a request, drawn alone (memory-only runs and tests); the gain is its own fitting one.
std::vector<std::byte> draw_frame(const MovieRequest& request, const ScopeCamera& camera,
                                  std::uint64_t frame);

}  // namespace orcart
