// Opens EGL without a window system where it can, and makes an OpenGL ES 3 context.
#include "render/egl/context.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

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

bool lists(const char* extensions, const char* wanted) {
  return extensions != nullptr && std::strstr(extensions, wanted) != nullptr;
}

EGLDisplay display_of(EGLenum platform, void* native) {
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  return get_display == nullptr ? EGL_NO_DISPLAY : get_display(platform, native, nullptr);
}

// The GPUs that EGL lists; a driver without the surfaceless platform (NVIDIA's) is reached by its device
// alone.
std::span<EGLDeviceEXT> gpus(std::span<EGLDeviceEXT> room) {
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto query_string =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
  EGLint listed = 0;
  if (query_devices == nullptr || query_string == nullptr ||
      query_devices(static_cast<EGLint>(room.size()), room.data(), &listed) == EGL_FALSE)
    return {};
  const auto found = room.first(static_cast<std::size_t>(listed));
  const auto end = std::remove_if(found.begin(), found.end(), [&](EGLDeviceEXT device) {
    return lists(query_string(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
  });
  return found.first(static_cast<std::size_t>(end - found.begin()));
}

bool is_software(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

}  // namespace

Result<GlContext> GlContext::create(const NativeDisplay& native) {
  if (native.gbm_device != nullptr)
    return on_display(display_of(EGL_PLATFORM_GBM_MESA, native.gbm_device), "on the panel's card by GBM");
  std::array<EGLDeviceEXT, 16> room{};
  for (EGLDeviceEXT gpu : gpus(room)) {
    auto context = on_display(display_of(EGL_PLATFORM_DEVICE_EXT, gpu), "on a GPU that it lists");
    if (context && context->render_class() == RenderClass::gpu) return context;
  }
  return on_display(display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY),
                    "without a window system (EGL_MESA_platform_surfaceless)");
}

Result<GlContext> GlContext::on_display(void* display, const char* where) {
  auto state = std::make_unique<State>();
  EGLint major = 0, minor = 0;
  if (display == EGL_NO_DISPLAY || eglInitialize(display, &major, &minor) == EGL_FALSE) {
    return fail(std::string("EGL cannot be opened ") + where + kRemedy);
  }
  state->display = display;
  eglBindAPI(EGL_OPENGL_ES_API);
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (eglChooseConfig(display, wanted, &config, 1, &count) == EGL_FALSE || count == 0) config = nullptr;
  const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 1, EGL_NONE};
  state->context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
  if (state->context == EGL_NO_CONTEXT) {
    return fail("this EGL offers no OpenGL ES 3.1 context" + std::string(kRemedy));
  }
  GlContext context(std::move(state));
  if (auto current = context.make_current(); !current) return tl::unexpected(current.error());
  State& s = *context.state_;
  s.renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  s.render_class = is_software(s.renderer) ? RenderClass::software : RenderClass::gpu;
  s.import_dma_buf = lists(eglQueryString(display, EGL_EXTENSIONS), "EGL_EXT_image_dma_buf_import");
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
