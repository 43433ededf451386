// The mean light of a view is the view's, not that of how it was cut into parts.
#include "render/atlas/view_light.hpp"

#include <gtest/gtest.h>

#include "tests/render/support/scenes.hpp"

namespace orcart {
namespace {

TEST(ViewLight, OfAViewInPartsIsThatOfTheWholeView) {
  const Surface surface = scenes::plane(20, 30, 50);  // 5,000 triangles
  ScopeModel scope = scenes::scope();
  scope.fall_off = {.reference_mm = 20, .vignetting_cos_power = 3};
  std::vector<std::uint32_t> all = scenes::whole(surface, {}).triangles;
  ViewLight whole;
  whole.begin({}, scope);
  whole.add(surface.mesh, all);

  const std::vector<std::uint32_t> rest(all.begin() + 4'700, all.end());
  all.resize(4'700);
  ViewLight parts;
  parts.begin({}, scope);
  parts.add(surface.mesh, all);
  parts.add(surface.mesh, rest);
  EXPECT_GT(whole.mean(), 0.3F);
  EXPECT_NEAR(parts.mean(), whole.mean(), 0.01F * whole.mean());
}

}  // namespace
}  // namespace orcart
