// Every cart.toml that is shipped is one that this orcartd reads.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "firmware-host/app/cart_config.hpp"
#include "tests/firmware-host/app/demo_cart.hpp"

namespace orcart::testing {
namespace {

TEST(ShippedCarts, AreReadWithoutAnError) {
  int carts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(demo_cart().parent_path())) {
    if (entry.path().filename().string().ends_with("registration.toml")) continue;
    const auto config = read_cart(entry.path());
    EXPECT_TRUE(config) << (config ? "" : config.error().message);
    ++carts;
  }
  EXPECT_GE(carts, 5) << "the demo, a Polaris, a Vega, a capture card, a grabber";
}

}  // namespace
}  // namespace orcart::testing
