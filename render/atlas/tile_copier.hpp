// Copies square tiles between two pictures on the GPU, byte for byte.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/gles/objects.hpp"

namespace orcart {

inline constexpr int kTileTexels = 32;

/// From tile position to tile position, both in texels.
struct TileMove {
  std::uint16_t from_x = 0, from_y = 0, to_x = 0, to_y = 0;
};

/// What a picture's texels are.
enum class TexelKind : std::uint8_t {
  colour,  ///< RGBA8
  record,  ///< RGBA16UI
};

class TileCopier {
 public:
  /// `most`: moves of one call.
  static Result<TileCopier> create(TexelKind kind, std::size_t most);
  struct Target {
    GLuint framebuffer = 0;
    int size_texels = 0;  ///< square
  };
  /// Source and target must not be the same picture. Allocates nothing.
  void copy(GLuint source_texture, const Target& target, std::span<const TileMove> moves) noexcept;

 private:
  TileCopier() = default;
  gles::Program program_;
  gles::VertexArray vertex_array_;
  gles::Buffer instances_;
  GLint target_size_ = -1, source_ = -1;
};

}  // namespace orcart
