// A small closed surface with known numbers, for the tests of every format.
#pragma once

#include <string>

#include "realtime/geometry/triangle_mesh.hpp"

namespace orcart {

/// The tetrahedron (0,0,0) (1,0,0) (0,2,0) (0,0,3): 1 mm3, closed, triangles counter-clockwise from outside.
inline TriangleMesh tetrahedron() {
  return {.vertices_mm = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

inline std::string ply_header(const std::string& format, const std::string& comment = "comment SPACE=LPS\n",
                              const std::string& vertices = "4", const std::string& faces = "4") {
  return "ply\nformat " + format + " 1.0\n" + comment + "element vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

inline std::string ascii_ply(const std::string& comment = "comment SPACE=LPS\n") {
  return ply_header("ascii", comment) + "0 0 0\n1 0 0\n0 2 0\n0 0 3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

}  // namespace orcart
