// The surfaces that come with the cart load, are closed, and are the ones their README names.
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "firmware-host/files/surface_file.hpp"

namespace orcart {
namespace {

class ShippedSurface : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Files, ShippedSurface, testing::Values("ventricle.ply", "cortex.ply"));

TEST_P(ShippedSurface, IsClosedAndAsItsReadmeSays) {
  const auto folder = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/surfaces";
  SurfaceNotes notes;
  const auto surface = read_surface(folder / GetParam(), &notes);
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_TRUE(surface->closed);
  EXPECT_TRUE(notes.sentences.empty());
  std::ifstream in(folder / "README.md");
  const std::string readme((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(readme.find(surface->identity.hash), std::string::npos);
}

}  // namespace
}  // namespace orcart
