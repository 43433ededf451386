// An OpenGL ES 3 context through EGL: on a GBM device for a panel; for files and simulation on a GPU that EGL
// lists, else surfaceless.
#pragma once

#include <memory>
#include <string>

#include "realtime/base/result.hpp"

namespace orcart {

/// The two classes that budgets are stated for.
enum class RenderClass { gpu, software };

/// What app may hand to EGL without either side knowing the other: a gbm_device* or nothing.
struct NativeDisplay {
  void* gbm_device =
      nullptr;  ///< null: the first GPU of EGL_EXT_device_enumeration, else EGL_MESA_platform_surfaceless
};

/// Owns display and context; the thread that calls make_current() is the only one that may draw.
class GlContext {
 public:
  static Result<GlContext> create(const NativeDisplay& native = {});
  GlContext(GlContext&&) noexcept;
  GlContext& operator=(GlContext&&) noexcept;
  ~GlContext();

  Result<void> make_current() noexcept;
  void release_current() noexcept;
  void finish() const noexcept;                       ///< waits until all that was asked for has been drawn
  RenderClass render_class() const noexcept;          ///< software for llvmpipe, softpipe and swrast
  const std::string& renderer_name() const noexcept;  ///< GL_RENDERER
  bool can_import_dma_buf() const noexcept;

 private:
  struct State;
  static Result<GlContext> on_display(void* display, const char* where);
  std::unique_ptr<State> state_;
  explicit GlContext(std::unique_ptr<State> state);
};

}  // namespace orcart
