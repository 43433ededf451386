// One instanced draw for any number of tiles.
#include "render/atlas/tile_copier.hpp"

#include <string>

#include "render/shaders/shaders.hpp"

namespace orcart {

Result<TileCopier> TileCopier::create(TexelKind kind, std::size_t most) {
  TileCopier self;
  const std::string fragment = (kind == TexelKind::record ? "#define RECORDS 1\n" : "#define RECORDS 0\n") +
                               std::string(shaders::copy_tiles_frag);
  auto program = gles::make_program("copy_tiles", shaders::copy_tiles_vert, fragment);
  if (!program) return tl::unexpected(program.error());
  self.program_ = std::move(*program);
  glUseProgram(self.program_.id());
  glUniform1f(gles::uniform(self.program_, "u_tile_size"), static_cast<float>(kTileTexels));
  self.target_size_ = gles::uniform(self.program_, "u_target_size");
  self.source_ = gles::uniform(self.program_, "u_source");
  self.vertex_array_ = gles::make_vertex_array();
  glBindVertexArray(self.vertex_array_.id());
  self.instances_ = gles::make_buffer(GL_ARRAY_BUFFER, most * sizeof(TileMove), nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_UNSIGNED_SHORT, GL_FALSE, sizeof(TileMove), nullptr);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);
  return self;
}

void TileCopier::copy(GLuint source_texture, const Target& target, std::span<const TileMove> moves) noexcept {
  if (moves.empty()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  glViewport(0, 0, target.size_texels, target.size_texels);
  glDisable(GL_BLEND);
  glUseProgram(program_.id());
  glUniform1f(target_size_, static_cast<float>(target.size_texels));
  glUniform1i(source_, 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, source_texture);
  glBindVertexArray(vertex_array_.id());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.id());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(moves.size_bytes()), moves.data());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(moves.size()));
  glBindVertexArray(0);
}

}  // namespace orcart
