// Opens EGL without a window system where it can, and makes an OpenGL ES 3 context.
#include "render/egl/context.hpp"

#include <cstring>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

namespace orcart {

struct GlContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string renderer;
  RenderClass render_class = RenderClass::software;
  bool import_dma_buf = false;

  ~State() {
    if (display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
    eglTerminate(display);
  }
};

namespace {

constexpr const char* kRemedy = "; install Debian's libegl1 and libgl1-mesa-dri, or the GPU's own driver";

EGLDisplay open_display(const NativeDisplay& native) {
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (get_display == nullptr) return EGL_NO_DISPLAY;
  if (native.gbm_device != nullptr) return get_display(EGL_PLATFORM_GBM_MESA, native.gbm_device, nullptr);
  return get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

bool is_software(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

}  // namespace

Result<GlContext> GlContext::create(const NativeDisplay& native) {
  auto state = std::make_unique<State>();
  state->display = open_display(native);
  EGLint major = 0, minor = 0;
  if (state->display == EGL_NO_DISPLAY || eglInitialize(state->display, &major, &minor) == EGL_FALSE) {
    state->display = EGL_NO_DISPLAY;
    return fail(std::string("EGL cannot be opened without a window system (EGL_MESA_platform_surfaceless)") +
                kRemedy);
  }
  eglBindAPI(EGL_OPENGL_ES_API);
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(state->display, wanted, &config, 1, &count) == EGL_FALSE || count == 0)
    config = nullptr;
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  state->context = eglCreateContext(state->display, config, EGL_NO_CONTEXT, version);
  if (state->context == EGL_NO_CONTEXT) {
    return fail("this EGL offers no OpenGL ES 3.1 context" + std::string(kRemedy));
  }
  GlContext context(std::move(state));
  if (auto current = context.make_current(); !current) return tl::unexpected(current.error());
  State& s = *context.state_;
  s.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  s.render_class = is_software(s.renderer) ? RenderClass::software : RenderClass::gpu;
  const char* extensions = eglQueryString(s.display, EGL_EXTENSIONS);
  s.import_dma_buf =
      extensions != nullptr && std::strstr(extensions, "EGL_EXT_image_dma_buf_import") != nullptr;
  return context;
}

GlContext::GlContext(std::unique_ptr<State> state) : state_(std::move(state)) {}
GlContext::GlContext(GlContext&&) noexcept = default;
GlContext& GlContext::operator=(GlContext&&) noexcept = default;
GlContext::~GlContext() = default;

Result<void> GlContext::make_current() noexcept {
  if (eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context) == EGL_TRUE) return {};
  return fail("the OpenGL ES context cannot be made current without a surface (EGL_KHR_surfaceless_context)");
}

void GlContext::release_current() noexcept {
  eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}
void GlContext::finish() const noexcept {
  glFinish();
}

RenderClass GlContext::render_class() const noexcept {
  return state_->render_class;
}
const std::string& GlContext::renderer_name() const noexcept {
  return state_->renderer;
}
bool GlContext::can_import_dma_buf() const noexcept {
  return state_->import_dma_buf;
}

}  // namespace orcart
