// Painting and drawing for callgrind to count, over Mesa's slowest driver and with a small atlas: what the
// driver does is left out of the sum, and what we do is the same with any.
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "render/egl/context.hpp"
#include "render/views/screen.hpp"
#include "tests/budget/counted.hpp"
#include "tests/render/support/scenes.hpp"

namespace orcart::testing {
namespace {

constexpr std::uint32_t kCells = 60;
constexpr int kPanelWidth = 160, kPanelHeight = 120;

/// A new picture of a wall, all of whose triangles are painted, and the panel's picture after it from a new
/// eye.
bool paint_and_draw(std::uint32_t rows, PaintBy by) {
  Surface wall = scenes::plane(12, 12, kCells);
  wall.mesh.triangles.resize(std::size_t{2} * kCells * rows);
  const auto layout = build_atlas(wall.mesh, {.texel_mm = 0.1});
  const ScopeModel scope = scenes::scope();
  if (!layout) return false;
  auto painter = Painter::create(wall, *layout, scope, {.light = LightModel::auto_exposure, .paint_by = by});
  auto screen = Screen::create(wall, *layout, scope,
                               {.width_px = kPanelWidth, .height_px = kPanelHeight, .draw_by = by});
  if (!painter || !screen) return false;
  const CutoutPatch patch = scenes::whole(wall, {});
  std::vector<std::byte> picture(packed_bytes(PixelFormat::nv12, scope.width_px, scope.height_px),
                                 std::byte{90});
  std::vector<std::byte> panel(packed_bytes(PixelFormat::xrgb8888, kPanelWidth, kPanelHeight));
  ScreenState state{.eye = eye_on(wall.mesh, -Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitY()),
                    .X_MC = patch.X_MC};
  state.status.video = state.status.tracker = Freshness::live;
  const auto frame = [&] {
    painter->upload(packed_image(picture.data(), PixelFormat::nv12, scope.width_px, scope.height_px));
    PaintReport report = painter->paint(patch, 1);
    while (report.carried) report = painter->paint_more();
  };
  const auto turn_and_draw = [&] {
    state.eye.position_mm.x() += 1;
    ++state.paint_version;
    screen->draw(state, *painter,
                 packed_image(panel.data(), PixelFormat::xrgb8888, kPanelWidth, kPanelHeight));
  };
  frame();  // its tiles are kept for undo from here on
  turn_and_draw();
  const int triangles = static_cast<int>(wall.mesh.triangles.size());
  CALLGRIND_START_INSTRUMENTATION;
  const bool gpu = by == PaintBy::gpu;
  count(gpu ? "painting" : "painting_by_processor", triangles, frame);
  count(gpu ? "drawing" : "drawing_by_processor", triangles, turn_and_draw);
  CALLGRIND_STOP_INSTRUMENTATION;
  return true;
}

}  // namespace
}  // namespace orcart::testing

int main() {
  using namespace orcart;
  setenv("GALLIUM_DRIVER", "softpipe", 1);  // it interprets: a translated shader costs minutes under valgrind
  if (!testing::pin_to_avx2()) return testing::kNoAvx2;
  CALLGRIND_STOP_INSTRUMENTATION;
  auto context = GlContext::create();
  if (!context || !context->make_current()) return EXIT_FAILURE;
  for (const PaintBy by : {PaintBy::gpu, PaintBy::processor})
    for (const std::uint32_t rows : {testing::kCells / 2, testing::kCells})
      if (!testing::paint_and_draw(rows, by)) return EXIT_FAILURE;
  return EXIT_SUCCESS;
}
