// OpenGL ES objects that free themselves: textures, buffers, framebuffers, programs. Errors carry the
// driver's log.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <GLES3/gl31.h>

#include "realtime/base/result.hpp"

namespace orcart::gles {

/// One GL name with the call that frees it; movable. The context must be current when it dies.
template <void (*Free)(GLuint)>
class Name {
 public:
  Name() = default;
  explicit Name(GLuint id) : id_(id) {}
  Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Name() {
    if (id_ != 0) Free(id_);
  }
  GLuint id() const noexcept { return id_; }
  explicit operator bool() const noexcept { return id_ != 0; }

 private:
  GLuint id_ = 0;
};

inline void free_texture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void free_buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void free_framebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
inline void free_renderbuffer(GLuint id) {
  glDeleteRenderbuffers(1, &id);
}
inline void free_vertex_array(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
inline void free_program(GLuint id) {
  glDeleteProgram(id);
}

using Texture = Name<free_texture>;
using Buffer = Name<free_buffer>;
using Framebuffer = Name<free_framebuffer>;
using Renderbuffer = Name<free_renderbuffer>;
using VertexArray = Name<free_vertex_array>;
using Program = Name<free_program>;

/// Size and format of a texture with immutable storage.
struct TextureShape {
  GLenum internal_format = GL_RGBA8;
  int width = 1, height = 1;
  GLint filter = GL_NEAREST;
  int levels = 1;  ///< more than one: the nearest level is looked up
};
Texture make_texture(const TextureShape& shape);

/// A vertex or index buffer of `bytes` bytes; `data` may be null.
Buffer make_buffer(GLenum target, std::size_t bytes, const void* data, GLenum usage);
VertexArray make_vertex_array();
/// Colour (and, where not 0, depth renderbuffer) attached; the error says what is incomplete.
Result<Framebuffer> make_framebuffer(GLuint colour_texture, GLuint depth_renderbuffer = 0);
Renderbuffer make_depth_buffer(int width, int height);

/// Compiles and links. The sources are bodies without `#version`; `name` is for the error.
Result<Program> make_program(std::string_view name, std::string_view vertex, std::string_view fragment);

/// A uniform's location; -1 where the program does not use it, which GL accepts silently.
inline GLint uniform(const Program& program, const char* name) {
  return glGetUniformLocation(program.id(), name);
}

}  // namespace orcart::gles
