// The demo's ventricle, scope and marker bodies, for tests that paint.
#pragma once

#include <cstdlib>
#include <filesystem>

#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "tools/evaluate/marker_bodies.hpp"
#include "tools/evaluate/scene.hpp"

namespace orcart {

/// Owns what its scene borrows: stays where it is made.
struct Demo {
  Demo() = default;
  Demo(const Demo&) = delete;
  Demo& operator=(const Demo&) = delete;

  std::filesystem::path share = std::filesystem::path(std::getenv("ORCART_SOURCE_DIR")) / "share";
  Surface surface = read_surface(share / "surfaces/ventricle.ply").value();
  RayScene rays = *RayScene::create(surface.mesh);
  ScopeModel scope = read_scope(share / "scopes/neuro-2p7.toml").value();
  EvaluationScene scene{.mesh = surface.mesh,
                        .rays = rays,
                        .scope = scope,
                        .X_MR = read_registration(share / "carts/demo-registration.toml")->X_MR,
                        .scope_markers_mm = markers_of_body(share / "tools/scope.rom").value(),
                        .reference_markers_mm = markers_of_body(share / "tools/reference.rom").value()};
};

}  // namespace orcart
