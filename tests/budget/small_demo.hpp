// The demo's cart, small enough to run on a busy machine without a GPU.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "firmware-host/app/cart_config.hpp"

namespace orcart::testing {

inline CartConfig small_demo(const char* name = "demo.toml") {
  auto config = read_cart(std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share/carts" / name);
  if (!config) ADD_FAILURE() << config.error().message;
  config->texel_mm = 0.4;
  config->panel = {.width_px = 640, .height_px = 480, .refresh_hz = 20};
  config->camera.rate_hz = 15;
  return *config;
}

}  // namespace orcart::testing
