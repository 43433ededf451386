// A painted surface as one binary glTF 2.0 file.
#pragma once

#include <string>
#include <string_view>

#include "firmware-host/files/textured_file.hpp"

namespace orcart {

/// The file's bytes. Vertices stay in millimetres, LPS, as everywhere; the node that holds them takes them to
/// glTF's metres with +Y up (superior) and +Z forward (anterior). The picture goes in as it is (`png`). The
/// material is a plain lit one: VTK 9.1 and what stands on it show no picture on one of KHR_materials_unlit.
/// A vertex is there once for each place in the picture. Layout: Khronos, glTF 2.0 specification, 2021,
/// sections 3.6 and 4.4.
std::string glb_bytes(const TexturedSurface& textured, std::string_view png);

}  // namespace orcart
