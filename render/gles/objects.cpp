// Making OpenGL ES objects.
#include "render/gles/objects.hpp"

#include <array>

namespace orcart::gles {

Texture make_texture(const TextureShape& shape) {
  GLuint id = 0;
  glGenTextures(1, &id);
  glBindTexture(GL_TEXTURE_2D, id);
  glTexStorage2D(GL_TEXTURE_2D, shape.levels, shape.internal_format, shape.width, shape.height);
  const GLint smaller = shape.levels == 1 ? shape.filter : GL_LINEAR_MIPMAP_LINEAR;
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, smaller);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, shape.filter);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return Texture(id);
}

Buffer make_buffer(GLenum target, std::size_t bytes, const void* data, GLenum usage) {
  GLuint id = 0;
  glGenBuffers(1, &id);
  glBindBuffer(target, id);
  glBufferData(target, static_cast<GLsizeiptr>(bytes), data, usage);
  return Buffer(id);
}

VertexArray make_vertex_array() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  return VertexArray(id);
}

Renderbuffer make_depth_buffer(int width, int height) {
  GLuint id = 0;
  glGenRenderbuffers(1, &id);
  glBindRenderbuffer(GL_RENDERBUFFER, id);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  return Renderbuffer(id);
}

Result<Framebuffer> make_framebuffer(GLuint colour_texture, GLuint depth_renderbuffer) {
  GLuint id = 0;
  glGenFramebuffers(1, &id);
  Framebuffer framebuffer(id);
  glBindFramebuffer(GL_FRAMEBUFFER, id);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_texture, 0);
  if (depth_renderbuffer != 0) {
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_renderbuffer);
  }
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    return fail("the driver cannot draw into a picture of this format (framebuffer status " +
                std::to_string(status) + ")");
  }
  return framebuffer;
}

namespace {

Result<GLuint> compile(std::string_view name, GLenum kind, std::string_view body) {
  const std::string source =
      "#version 310 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n"
      "precision highp usampler2D;\n" +
      std::string(body);
  const GLuint shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint ok = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
  if (ok != 0) return shader;
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
  glDeleteShader(shader);
  return fail("the driver refuses the shader " + std::string(name) + ": " + log.data());
}

}  // namespace

Result<Program> make_program(std::string_view name, std::string_view vertex, std::string_view fragment) {
  const auto vertex_shader = compile(name, GL_VERTEX_SHADER, vertex);
  if (!vertex_shader) return tl::unexpected(vertex_shader.error());
  const auto fragment_shader = compile(name, GL_FRAGMENT_SHADER, fragment);
  if (!fragment_shader) {
    glDeleteShader(*vertex_shader);
    return tl::unexpected(fragment_shader.error());
  }
  Program program(glCreateProgram());
  glAttachShader(program.id(), *vertex_shader);
  glAttachShader(program.id(), *fragment_shader);
  glLinkProgram(program.id());
  glDeleteShader(*vertex_shader);
  glDeleteShader(*fragment_shader);
  GLint ok = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &ok);
  if (ok != 0) return program;
  std::array<char, 2048> log{};
  glGetProgramInfoLog(program.id(), log.size(), nullptr, log.data());
  return fail("the driver cannot link the shaders of " + std::string(name) + ": " + log.data());
}

}  // namespace orcart::gles
