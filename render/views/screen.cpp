// Layers: the kept view of the surface, the scope over it, the inset, the words; then out to the panel's
// buffer.
#include "render/views/screen.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include <GLES3/gl31.h>

#include <GLES2/gl2ext.h>

#include "realtime/optics/scope_turn.hpp"
#include "render/gles/dma_buf_framebuffers.hpp"
#include "render/gles/picture_texture.hpp"
#include "render/hud/status_panel.hpp"
#include "render/shaders/shaders.hpp"
#include "render/views/scope_outline.hpp"
#include "render/views/software/processor_inset.hpp"
#include "render/views/surface_view.hpp"

namespace orcart {
namespace {

/// Every square of `finer` x `finer` pixels becomes one.
AtlasPicture averaged(const std::vector<std::uint8_t>& fine, const ScreenSettings& settings, int finer) {
  AtlasPicture picture{.width_texels = settings.width_px, .height_texels = settings.height_px, .rgba = {}};
  const auto width = static_cast<std::size_t>(settings.width_px), step = static_cast<std::size_t>(finer);
  picture.rgba.resize(4 * width * static_cast<std::size_t>(settings.height_px));
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
    const std::size_t channel = i % 4, x = i / 4 % width * step, y = i / 4 / width * step;
    unsigned sum = 0;
    for (std::size_t row = y; row < y + step; ++row)
      for (std::size_t column = x; column < x + step; ++column)
        sum += fine[4 * (row * width * step + column) + channel];
    picture.rgba[i] = static_cast<std::uint8_t>((sum + step * step / 2) / (step * step));
  }
  return picture;
}

PixelBox united(const PixelBox& a, const PixelBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

}  // namespace

struct Screen::State {
  ScreenSettings settings;
  ScopeModel scope;
  PanelLayout layout;
  std::optional<SurfaceView> view;  ///< this and the next once create() is done
  std::optional<HudCanvas> canvas;
  gles::Texture picture;
  gles::Framebuffer framebuffer;
  gles::Texture status_picture;  ///< column and bar, as `told`
  gles::Framebuffer status_framebuffer;
  struct Told {
    Status status;
    InsetContent inset = InsetContent::blank;
    bool operator==(const Told&) const = default;
  };
  std::optional<Told> told;
  PixelBox stale_view;       ///< of `framebuffer`: what is not as the view's picture is, in the view's pixels
  bool stale_status = true;  ///< of `framebuffer`: column and bar are not as told
  gles::DmaBufFramebuffers shared{4};             ///< targets in dma-bufs, drawn into without a copy
  std::optional<ProcessorInset> processor_inset;  ///< where the processor draws
  gles::Program inset;
  gles::VertexArray no_attributes;
  gles::PictureTexture::Uniforms picture_uniforms{};
  GLint circle = -1;  ///< of the inset
  Eye drawn_eye;
  std::uint64_t drawn_version = 0, drawn_changes = 0;
  bool drawn = false;
  bool reads_bgra = false;

  Result<void> make_inset();
  Result<void> make_gpu_inset();
  void warm_up();
  void redraw(const ScreenState& state, const Painter& painter, const PaintedAtlas& paint) noexcept;
  PixelBox whole_view() const noexcept {
    return {0, 0, view->settings().width_px, view->settings().height_px};
  }
  void show_view(GLuint into) noexcept;
  void show_status(const Told& now, GLuint into) noexcept;
  void cover(const HudBox& box) noexcept;
  void draw_inset(const gles::PictureTexture& live, const CircularMask& mask, GLuint into) noexcept;
  GLuint shared_target(const ImageDescriptor& target) noexcept;
  bool read_into(const ImageDescriptor& target) noexcept;
};

Result<void> Screen::State::make_inset() {
  no_attributes = gles::make_vertex_array();
  if (settings.draw_by == PaintBy::gpu) return make_gpu_inset();
  auto made = ProcessorInset::create(layout.inset_centre.x, layout.inset_centre.y, layout.inset_radius_px,
                                     static_cast<float>(scope.lens.fx_px / scope.lens.fy_px));
  if (!made) return tl::unexpected(made.error());
  processor_inset = std::move(*made);
  return {};
}

Result<void> Screen::State::make_gpu_inset() {
  const std::string fragment = std::string(shaders::dialect_glsl) + shaders::paint_uniforms_glsl +
                               shaders::picture_textures_glsl + shaders::picture_glsl + shaders::inset_glsl +
                               shaders::inset_frag;
  auto program = gles::make_program("inset", shaders::inset_vert, fragment);
  if (!program) return tl::unexpected(program.error());
  inset = std::move(*program);
  glUseProgram(inset.id());
  const float radius = layout.inset_radius_px;
  glUniform4f(gles::uniform(inset, "u_box"), layout.inset_centre.x - radius, layout.inset_centre.y - radius,
              2 * radius, 2 * radius);
  glUniform2f(gles::uniform(inset, "u_panel_size"), static_cast<float>(settings.width_px),
              static_cast<float>(settings.height_px));
  circle = gles::uniform(inset, "u_circle");
  glUniform1f(gles::uniform(inset, "u_aspect"), static_cast<float>(scope.lens.fx_px / scope.lens.fy_px));
  glUniform1f(gles::uniform(inset, "u_radius_px"), radius);
  picture_uniforms = gles::PictureTexture::uniforms_of(inset);
  return {};
}

Result<Screen> Screen::create(const Surface& surface, const AtlasLayout& layout, const ScopeModel& scope,
                              const ScreenSettings& settings) {
  auto state = std::make_unique<State>();
  state->settings = settings;
  state->scope = scope;
  state->layout = panel_layout(settings.width_px, settings.height_px);
  auto view = SurfaceView::create(surface, layout,
                                  {.width_px = static_cast<int>(state->layout.view.width),
                                   .height_px = static_cast<int>(state->layout.view.height),
                                   .seen_from = settings.seen_from,
                                   .colour_by = settings.colour_by,
                                   .most_triangles = settings.most_triangles,
                                   .draw_by = settings.draw_by});
  if (!view) return tl::unexpected(view.error());
  state->view = std::move(*view);
  auto canvas = HudCanvas::create({.width_px = settings.width_px, .height_px = settings.height_px});
  if (!canvas) return tl::unexpected(canvas.error());
  state->canvas = std::move(*canvas);
  state->stale_view = state->whole_view();
  state->picture = gles::make_texture({GL_RGBA8, settings.width_px, settings.height_px});
  auto framebuffer = gles::make_framebuffer(state->picture.id());
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  state->framebuffer = std::move(*framebuffer);
  state->status_picture = gles::make_texture({GL_RGBA8, settings.width_px, settings.height_px});
  auto status_framebuffer = gles::make_framebuffer(state->status_picture.id());
  if (!status_framebuffer) return tl::unexpected(status_framebuffer.error());
  state->status_framebuffer = std::move(*status_framebuffer);
  if (auto made = state->make_inset(); !made) return tl::unexpected(made.error());
  const char* extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  state->reads_bgra = extensions != nullptr && std::strstr(extensions, "GL_EXT_read_format_bgra") != nullptr;
  state->warm_up();
  return Screen(std::move(state));
}

// Draws everything once, for software drivers translate a shader when something is first drawn with it.
void Screen::State::warm_up() {
  const gles::Texture unpainted = gles::make_texture({GL_RGBA8, 1, 1, GL_LINEAR});
  const gles::Texture unknown = gles::make_texture({GL_RGBA16UI, 1, 1});
  Eye eye;
  eye.position_mm = {0, 0, 1};
  view->draw(eye, {unpainted.id(), unknown.id()}, {});
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, settings.width_px, settings.height_px);
  draw_column_and_bar(*canvas, layout, {}, InsetContent::blank);
  glFinish();
  if (settings.draw_by == PaintBy::processor) return;
  std::vector<std::byte> black(packed_bytes(PixelFormat::rgba8888, scope.width_px, scope.height_px));
  gles::PictureTexture live(scope.width_px, scope.height_px);
  for (const PixelFormat format : {PixelFormat::yuyv, PixelFormat::nv12, PixelFormat::rgba8888}) {
    live.upload(packed_image(black.data(), format, scope.width_px, scope.height_px));
    draw_inset(live, scope.mask, framebuffer.id());
  }
  glFinish();
}

Screen::Screen(std::unique_ptr<State> state) : state_(std::move(state)) {}
Screen::Screen(Screen&&) noexcept = default;
Screen& Screen::operator=(Screen&&) noexcept = default;
Screen::~Screen() = default;

void Screen::State::draw_inset(const gles::PictureTexture& live, const CircularMask& mask,
                               GLuint into) noexcept {
  if (processor_inset) {
    processor_inset->draw(live.in_memory(), mask, into);
    return;
  }
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(inset.id());
  glUniform4f(circle, static_cast<float>(mask.cx_px), static_cast<float>(mask.cy_px),
              static_cast<float>(mask.radius_px), 0);
  live.bind(picture_uniforms, 0);
  glBindVertexArray(no_attributes.id());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
  glActiveTexture(GL_TEXTURE0);
}

/// Our own picture holds the last one, so what has not changed is there already; a shared one may hold
/// anything.
void Screen::State::show_view(GLuint into) noexcept {
  const bool own = into == framebuffer.id();
  const PixelBox part = own ? stale_view : whole_view();
  if (!part.empty())
    view->copy_to(into, static_cast<int>(layout.view.x), static_cast<int>(layout.view.y), part);
  stale_view = own ? PixelBox{} : whole_view();
}

/// Words are drawn when what they say has changed, and copied from then on. Leaves `into` bound.
void Screen::State::show_status(const Told& now, GLuint into) noexcept {
  const bool own = into == framebuffer.id(), renewed = told != now;
  if (renewed) {
    glBindFramebuffer(GL_FRAMEBUFFER, status_framebuffer.id());
    draw_column_and_bar(*canvas, layout, now.status, now.inset);
    if (processor_inset) processor_inset->lay_on(status_framebuffer.id());
    told = now;
  }
  const bool kept = own && !renewed && !stale_status && processor_inset;  // the driver's inset blends with it
  stale_status = !own;
  glBindFramebuffer(GL_FRAMEBUFFER, into);
  if (kept) return;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, status_framebuffer.id());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, into);
  for (const HudBox& box : {layout.column, layout.bar}) {
    const auto x = static_cast<GLint>(box.x), y = static_cast<GLint>(box.y);
    const GLint right = std::min(static_cast<GLint>(std::ceil(box.x + box.width)), settings.width_px),
                bottom = std::min(static_cast<GLint>(std::ceil(box.y + box.height)), settings.height_px);
    glBlitFramebuffer(x, y, right, bottom, x, y, right, bottom, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, into);
}

/// Something was drawn there into our own picture.
void Screen::State::cover(const HudBox& box) noexcept {
  const HudBox& view_box = layout.view;
  const auto left = static_cast<int>(std::floor(box.x - view_box.x)),
             top = static_cast<int>(std::floor(box.y - view_box.y)),
             right = static_cast<int>(std::ceil(box.x - view_box.x + box.width)),
             bottom = static_cast<int>(std::ceil(box.y - view_box.y + box.height));
  const PixelBox whole = whole_view();
  const int x = std::clamp(left, 0, whole.width), y = std::clamp(top, 0, whole.height);
  stale_view = united(stale_view,
                      {x, y, std::clamp(right, 0, whole.width) - x, std::clamp(bottom, 0, whole.height) - y});
  stale_status = stale_status || right > whole.width || bottom > whole.height;
}

void Screen::State::redraw(const ScreenState& state, const Painter& painter,
                           const PaintedAtlas& paint) noexcept {
  if (drawn && drawn_version == state.paint_version && drawn_eye == state.eye && view->settled()) return;
  constexpr std::uint64_t kRemembered = 16;
  Eigen::AlignedBox3f changed;
  const std::uint64_t now = painter.changes();
  for (std::uint64_t i = std::max(drawn_changes, now > kRemembered ? now - kRemembered - 1 : 0) + 1; i <= now;
       ++i) {
    changed.extend(painter.touched_by(i));
  }
  stale_view = united(stale_view, view->draw(state.eye, paint, changed));
  drawn = true;
  drawn_version = state.paint_version;
  drawn_changes = now;
  drawn_eye = state.eye;
}

bool Screen::draw(const ScreenState& state, const Painter& painter, const ImageDescriptor& target) noexcept {
  State& s = *state_;
  const PaintedAtlas paint = painter.painted(s.settings.draw_by);
  if (s.settings.draw_by == PaintBy::processor && paint.colours == nullptr) return false;
  s.redraw(state, painter, paint);
  const bool copies = target.planes[0].data != nullptr;
  const GLuint into = copies ? s.framebuffer.id() : s.shared_target(target);
  if (into == 0) return false;
  s.show_view(into);
  const bool live = state.show_live && !painter.picture().empty();
  s.show_status({state.status, live ? InsetContent::picture : InsetContent::blank}, into);
  HudCanvas& canvas = *s.canvas;
  const TurnedOptics optics = optics_at(s.scope, state.turn_rad);
  if (state.X_MC)
    draw_scope(canvas, s.layout.view, state.eye,
               {.X_MC = *state.X_MC,
                .X_CE = optics.X_CE,
                .shaft = shaft_of(s.scope, optics),
                .cone_half_angle_rad = s.scope.cone_half_angle_rad,
                .predicted = state.scope_predicted});
  draw_banners(canvas, s.layout, state.status);
  if (copies) s.cover(canvas.bounds());
  canvas.flush();
  glViewport(0, 0, s.settings.width_px, s.settings.height_px);
  if (live) s.draw_inset(painter.picture(), optics.mask, into);
  if (copies) return s.read_into(target);
  glFinish();  // the panel does not wait for a renderer without fences
  return true;
}

GLuint Screen::State::shared_target(const ImageDescriptor& target) noexcept {
  const bool fits = target.width_px == settings.width_px && target.height_px == settings.height_px &&
                    target.format == PixelFormat::xrgb8888;
  return fits ? shared.over(target.planes[0], {.drm_format = static_cast<std::uint32_t>(target.format),
                                               .width_px = target.width_px,
                                               .height_px = target.height_px,
                                               .modifier = target.modifier})
              : 0;
}

bool Screen::State::read_into(const ImageDescriptor& target) noexcept {
  const ImagePlane& plane = target.planes[0];
  const bool bgr = target.format == PixelFormat::xrgb8888;
  if (plane.data == nullptr || target.width_px != settings.width_px ||
      target.height_px != settings.height_px || (!bgr && target.format != PixelFormat::rgba8888)) {
    return false;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(plane.stride_bytes / 4));
  std::byte* const first = plane.data + plane.offset_bytes;
  glReadPixels(0, 0, settings.width_px, settings.height_px, bgr && reads_bgra ? GL_BGRA_EXT : GL_RGBA,
               GL_UNSIGNED_BYTE, first);
  glPixelStorei(GL_PACK_ROW_LENGTH, 0);
  if (!bgr || reads_bgra) return true;
  for (int y = 0; y < settings.height_px; ++y) {
    std::byte* row = first + static_cast<std::size_t>(y) * plane.stride_bytes;
    for (int x = 0; x < settings.width_px; ++x) std::swap(row[4 * x], row[4 * x + 2]);
  }
  return true;
}

Result<AtlasPicture> picture_of_surface(const Surface& surface, const AtlasLayout& layout,
                                        const Painter& painter, const Eye& eye,
                                        const ScreenSettings& settings) {
  constexpr int kFiner = 2;  // drawn larger and averaged, against jagged edges
  const int width = settings.width_px * kFiner, height = settings.height_px * kFiner;
  auto view = SurfaceView::create(surface, layout,
                                  {.width_px = width,
                                   .height_px = height,
                                   .seen_from = settings.seen_from,
                                   .colour_by = settings.colour_by,
                                   .most_triangles = surface.mesh.triangles.size(),
                                   .draw_by = settings.draw_by});
  if (!view) return tl::unexpected(view.error());
  view->draw(eye, painter.painted(settings.draw_by), {});
  std::vector<std::uint8_t> fine(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_FRAMEBUFFER, view->framebuffer());
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, fine.data());
  return averaged(fine, settings, kFiner);
}

}  // namespace orcart
