// A paint pass: depth of the cutout from the scope, then one quad per touched cell of the atlas through the
// paint shader.
#include "render/atlas/painter.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/atlas/coverage_counter.hpp"
#include "render/atlas/scope_depth.hpp"
#include "render/atlas/surface_textures.hpp"
#include "render/atlas/undo_store.hpp"
#include "render/gles/picture_texture.hpp"
#include "render/shaders/shaders.hpp"

namespace orcart {
namespace {

constexpr int kMaskRow = 2048;   // words in a row of the paper mode's triangle mask
constexpr int kCellTexels = 16;  // what is painted is drawn in squares of this size
static_assert(kTileTexels % kCellTexels == 0);

struct PaintUniforms {
  GLint rotation, translation, paper, tip, view, up, side, paper_size, cos_cone;
};

/// The tangents of the rectified picture that paper mode speaks of: its centre and half extents.
Eigen::Vector4f paper_frame_of(const ScopeModel& scope) {
  const auto slope = [&](double dx, double dy) -> Eigen::Vector2d {
    const double aspect = scope.lens.fy_px / scope.lens.fx_px;
    const auto d = direction_of(scope.lens, {scope.mask.cx_px + dx * scope.mask.radius_px,
                                             scope.mask.cy_px + dy * scope.mask.radius_px * aspect});
    return d ? Eigen::Vector2d(d->x() / d->z(), d->y() / d->z()) : Eigen::Vector2d(dx, dy);
  };
  const Eigen::Vector2d left = slope(-1, 0), right = slope(1, 0), top = slope(0, -1), bottom = slope(0, 1);
  return {static_cast<float>(0.5 * (left.x() + right.x())), static_cast<float>(0.5 * (top.y() + bottom.y())),
          static_cast<float>(0.5 * (right.x() - left.x())), static_cast<float>(0.5 * (bottom.y() - top.y()))};
}

void set_lens_uniforms(const gles::Program& program, const ScopeModel& scope) {
  const Lens& lens = scope.lens;
  const int model = lens.model == LensModel::brown ? 0 : lens.model == LensModel::poly4 ? 1 : 2;
  glUniform1i(gles::uniform(program, "u_lens_model"), model);
  glUniform4f(gles::uniform(program, "u_intrinsics"), static_cast<float>(lens.fx_px),
              static_cast<float>(lens.fy_px), static_cast<float>(lens.cx_px), static_cast<float>(lens.cy_px));
  std::array<float, 5> coefficients{};
  for (std::size_t i = 0; i < 5; ++i) coefficients[i] = static_cast<float>(lens.coefficients[i]);
  glUniform1fv(gles::uniform(program, "u_coefficients"), 5, coefficients.data());
  glUniform2f(gles::uniform(program, "u_distortion_centre"),
              static_cast<float>(lens.distortion_centre_px.x()),
              static_cast<float>(lens.distortion_centre_px.y()));
  glUniform4f(gles::uniform(program, "u_circle"), static_cast<float>(scope.mask.cx_px),
              static_cast<float>(scope.mask.cy_px), static_cast<float>(scope.mask.radius_px),
              static_cast<float>(std::max(scope.mask.soft_edge_px, 1e-3)));
  glUniform1f(gles::uniform(program, "u_aspect"), static_cast<float>(lens.fx_px / lens.fy_px));
  glUniform1f(gles::uniform(program, "u_pixel_rad"), static_cast<float>(1.0 / lens.fx_px));
}

}  // namespace

struct Painter::State {
  const AtlasLayout* layout = nullptr;
  ScopeModel scope;
  PainterSettings settings;
  SurfaceTextures surface;
  std::vector<ScopeDepth> depth;              ///< exactly one
  std::vector<UndoStore> undo;                ///< exactly one
  std::vector<CoverageCounter> coverage;      ///< exactly one
  std::vector<gles::PictureTexture> picture;  ///< exactly one
  gles::Texture atlas, mask;
  gles::Framebuffer framebuffer;
  gles::Program program;
  gles::VertexArray vertex_array;
  gles::Buffer rects;
  PaintUniforms uniforms{};
  gles::PictureTexture::Uniforms picture_uniforms{};

  std::vector<std::uint32_t> seen_cell, seen_tile;  ///< epoch of the view, or step, that touched it last
  std::uint32_t epoch = 0, cells_per_row = 0;
  std::vector<std::uint32_t> cells;  ///< of the view, in order; painted up to `painted`
  std::size_t painted = 0;
  std::vector<std::uint32_t> tiles;
  std::vector<ChartRect> quads;
  std::vector<std::uint32_t> mask_words;
  Pose<C, M> X_CM;
  TextureMode mode = TextureMode::perspective;
  PaperProjection paper;
  std::uint32_t unit = 0;

  KeptAtlas kept() const { return {atlas.id(), framebuffer.id(), layout->width_texels}; }
  Result<void> make_program();
  Result<void> make_atlas(const Surface& surface);
  void collect(const CutoutPatch& patch) noexcept;
  void collect_cells(std::uint32_t triangle) noexcept;
  void collect_tile(std::uint32_t cell) noexcept;
  void set_view() noexcept;
  void bind_textures() noexcept;
  PaintReport paint_some() noexcept;
};

Result<void> Painter::State::make_program() {
  const std::string fragment = std::string(shaders::lens_glsl) + shaders::picture_glsl + shaders::paint_frag;
  auto made = gles::make_program("paint", shaders::paint_vert, fragment);
  if (!made) return tl::unexpected(made.error());
  program = std::move(*made);
  glUseProgram(program.id());
  set_lens_uniforms(program, scope);
  const auto at = [&](const char* name) { return gles::uniform(program, name); };
  glUniform1f(at("u_atlas_size"), static_cast<float>(layout->width_texels));
  glUniform1f(at("u_facing"), settings.seen_from == SeenFrom::outside ? 1.0f : -1.0f);
  glUniform1f(at("u_cos_cone"), static_cast<float>(std::cos(scope.cone_half_angle_rad)));
  glUniform1f(at("u_far_mm"), static_cast<float>(scope.far_mm));
  glUniform1f(at("u_cos_obliquity"), static_cast<float>(std::cos(settings.max_obliquity_rad)));
  const DepthPinhole& pinhole = depth[0].pinhole();
  glUniform1f(at("u_depth_tangent"), pinhole.tangent);
  glUniform1f(at("u_depth_near"), pinhole.near_mm);
  glUniform1f(at("u_depth_far"), pinhole.far_mm);
  glUniform4f(at("u_fall_off"),
              settings.even_out_light ? static_cast<float>(scope.fall_off.reference_mm) : 0.0f,
              static_cast<float>(scope.fall_off.vignetting_cos_power), 0, 0);
  const Eigen::Vector4f frame = paper_frame_of(scope);
  glUniform4fv(at("u_paper_frame"), 1, frame.data());
  const char* units[] = {"u_owner", "u_weights", "u_triangles", "u_vertices",
                         "u_depth", "u_mask",    "u_points"};
  for (int unit_number = 0; unit_number < 7; ++unit_number) glUniform1i(at(units[unit_number]), unit_number);
  uniforms = {at("u_rotation_CM"), at("u_translation_CM"), at("u_paper"),      at("u_tip"),     at("u_view"),
              at("u_up"),          at("u_side"),           at("u_paper_size"), at("u_cos_cone")};
  picture_uniforms = gles::PictureTexture::uniforms_of(program);
  return {};
}

Result<void> Painter::State::make_atlas(const Surface& from) {
  surface = make_surface_textures(from.mesh, *layout);
  atlas = gles::make_texture({GL_RGBA8, layout->width_texels, layout->height_texels, GL_LINEAR});
  auto made = gles::make_framebuffer(atlas.id());
  if (!made) return tl::unexpected(made.error());
  framebuffer = std::move(*made);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  const std::size_t words = (from.mesh.triangles.size() + 31) / 32;
  const int rows = static_cast<int>((words + kMaskRow - 1) / kMaskRow);
  mask_words.assign(static_cast<std::size_t>(rows) * kMaskRow, 0);
  mask = gles::make_texture({GL_R32UI, kMaskRow, rows});

  vertex_array = gles::make_vertex_array();
  glBindVertexArray(vertex_array.id());
  cells_per_row = static_cast<std::uint32_t>(layout->width_texels / kCellTexels);
  const std::size_t cell_count = static_cast<std::size_t>(cells_per_row) * cells_per_row;
  rects = gles::make_buffer(GL_ARRAY_BUFFER, cell_count * sizeof(ChartRect), nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_UNSIGNED_SHORT, GL_FALSE, sizeof(ChartRect), nullptr);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);

  const std::size_t tile_count = static_cast<std::size_t>(layout->width_texels / kTileTexels) *
                                 static_cast<std::size_t>(layout->height_texels / kTileTexels);
  seen_cell.assign(cell_count, 0);
  seen_tile.assign(tile_count, 0);
  cells.reserve(cell_count);
  quads.reserve(cell_count);
  tiles.reserve(tile_count);
  auto store = UndoStore::create(kept(), settings.undo_units);
  if (!store) return tl::unexpected(store.error());
  undo.push_back(std::move(*store));
  const auto texels = static_cast<std::uint64_t>(std::count(layout->inside.begin(), layout->inside.end(), 1));
  auto counter = CoverageCounter::create(kept(), surface.owner.id(), texels);
  if (!counter) return tl::unexpected(counter.error());
  coverage.push_back(std::move(*counter));
  return {};
}

Result<Painter> Painter::create(const Surface& surface, const AtlasLayout& layout, const ScopeModel& scope,
                                const PainterSettings& settings) {
  auto state = std::make_unique<State>();
  state->layout = &layout;
  state->scope = scope;
  state->settings = settings;
  constexpr double kWidest = 1.4;  // 80 degrees: beyond, a pinhole depth picture has no resolution left
  if (scope.cone_half_angle_rad > kWidest - 0.03) {
    return fail("the scope's viewing cone is wider than 78 degrees off its axis; the painter takes less");
  }
  const DepthPinhole pinhole{.tangent = static_cast<float>(std::tan(scope.cone_half_angle_rad + 0.03)),
                             .near_mm = 0.3f,
                             .far_mm = static_cast<float>(scope.far_mm * 1.25)};
  auto depth = ScopeDepth::create(surface.mesh, pinhole);
  if (!depth) return tl::unexpected(depth.error());
  state->depth.push_back(std::move(*depth));
  state->picture.emplace_back(scope.width_px, scope.height_px);
  if (auto made = state->make_atlas(surface); !made) return tl::unexpected(made.error());
  if (auto made = state->make_program(); !made) return tl::unexpected(made.error());
  return Painter(std::move(state));
}

Painter::Painter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Painter::Painter(Painter&&) noexcept = default;
Painter& Painter::operator=(Painter&&) noexcept = default;
Painter::~Painter() = default;

bool Painter::upload(const ImageDescriptor& image) noexcept {
  return state_->picture[0].upload(image);
}

/// The cells that hold a triangle's own texels and its gutter.
void Painter::State::collect_cells(std::uint32_t triangle) noexcept {
  constexpr float kGutter = 3;
  const auto& corners = layout->corners_texels[triangle];
  const ChartRect& rect = layout->charts[layout->chart_of_triangle[triangle]];
  const auto cell = [&](float texel, int first, int extent) {
    return static_cast<std::uint32_t>(std::clamp(static_cast<int>(texel), first, first + extent - 1)) /
           kCellTexels;
  };
  const Eigen::Vector2f low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).array() - kGutter;
  const Eigen::Vector2f high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).array() + kGutter;
  const std::uint32_t x0 = cell(low.x(), rect.x, rect.width), x1 = cell(high.x(), rect.x, rect.width);
  const std::uint32_t y0 = cell(low.y(), rect.y, rect.height), y1 = cell(high.y(), rect.y, rect.height);
  for (std::uint32_t y = y0; y <= y1; ++y) {  // bound: a chart's extent
    for (std::uint32_t x = x0; x <= x1; ++x) {
      const std::uint32_t number = y * cells_per_row + x;
      if (seen_cell[number] == epoch) continue;
      seen_cell[number] = epoch;
      cells.push_back(number);
    }
  }
}

void Painter::State::collect_tile(std::uint32_t cell) noexcept {
  constexpr std::uint32_t kCellsPerTile = kTileTexels / kCellTexels;
  const std::uint32_t tile = cell / cells_per_row / kCellsPerTile * (cells_per_row / kCellsPerTile) +
                             cell % cells_per_row / kCellsPerTile;
  if (seen_tile[tile] == epoch) return;
  seen_tile[tile] = epoch;
  tiles.push_back(tile);
}

void Painter::State::collect(const CutoutPatch& patch) noexcept {
  if (patch.first_part) {
    ++epoch;
    cells.clear();
    painted = 0;
    X_CM = patch.X_MC.inverse();
    mode = patch.mode;
    paper = patch.paper;
    if (mode == TextureMode::paper) std::fill(mask_words.begin(), mask_words.end(), 0u);
  }
  for (const std::uint32_t triangle : patch.triangles) {
    if (mode == TextureMode::paper) mask_words[triangle >> 5] |= 1u << (triangle & 31);
    collect_cells(triangle);
  }
}

PaintReport Painter::paint(const CutoutPatch& patch, std::uint32_t unit) noexcept {
  State& s = *state_;
  if (s.picture[0].empty() || (patch.mode == TextureMode::paper && !patch.paper.valid)) return {};
  s.collect(patch);
  s.unit = unit;
  if (patch.mode == TextureMode::perspective) s.depth[0].draw(patch, s.X_CM);
  if (!patch.last_part) return {};
  if (s.mode == TextureMode::paper) {
    glBindTexture(GL_TEXTURE_2D, s.mask.id());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, kMaskRow, static_cast<GLsizei>(s.mask_words.size() / kMaskRow),
                    GL_RED_INTEGER, GL_UNSIGNED_INT, s.mask_words.data());
  }
  return s.paint_some();
}

PaintReport Painter::paint_more() noexcept {
  return state_->paint_some();
}

PaintReport Painter::State::paint_some() noexcept {
  PaintReport report;
  quads.clear();
  tiles.clear();
  ++epoch;  // tiles are told apart from those of the step before
  constexpr std::uint32_t kTexelsOfCell = kCellTexels * kCellTexels;
  for (; painted < cells.size() && report.texels + kTexelsOfCell <= settings.max_texels_per_step; ++painted) {
    const std::uint32_t cell = cells[painted];
    report.texels += kTexelsOfCell;
    quads.push_back({static_cast<std::uint16_t>(cell % cells_per_row * kCellTexels),
                     static_cast<std::uint16_t>(cell / cells_per_row * kCellTexels), kCellTexels,
                     kCellTexels});
    collect_tile(cell);
  }
  report.painted = !quads.empty();
  report.carried = painted < cells.size();
  if (!report.painted) return report;
  undo[0].keep(unit, tiles);
  coverage[0].touch(tiles);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, layout->width_texels, layout->height_texels);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program.id());
  set_view();
  bind_textures();
  glBindVertexArray(vertex_array.id());
  glBindBuffer(GL_ARRAY_BUFFER, rects.id());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(quads.size() * sizeof(ChartRect)),
                  quads.data());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(quads.size()));
  glBindVertexArray(0);
  glDisable(GL_BLEND);
  return report;
}

void Painter::State::set_view() noexcept {
  set_pose_uniforms(uniforms.rotation, uniforms.translation, X_CM);
  glUniform1i(uniforms.paper, mode == TextureMode::paper ? 1 : 0);
  glUniform3fv(uniforms.tip, 1, paper.tip_mm.data());
  glUniform3fv(uniforms.view, 1, paper.view.data());
  glUniform3fv(uniforms.up, 1, paper.up.data());
  glUniform3fv(uniforms.side, 1, paper.side.data());
  glUniform2f(uniforms.paper_size, paper.s_size_mm, paper.t_size_mm);
}

void Painter::State::bind_textures() noexcept {
  const GLuint textures[] = {surface.owner.id(),    surface.weights.id(), surface.triangles.id(),
                             surface.vertices.id(), depth[0].texture(),   mask.id(),
                             surface.points.id()};
  for (GLenum i = 0; i < 7; ++i) {
    glActiveTexture(GL_TEXTURE0 + i);
    glBindTexture(GL_TEXTURE_2D, textures[i]);
  }
  picture[0].bind(picture_uniforms, 7);
  glActiveTexture(GL_TEXTURE0);
}

bool Painter::undo() noexcept {
  const auto tiles = state_->undo[0].undo();
  state_->coverage[0].touch(tiles);
  return !tiles.empty();
}

bool Painter::redo() noexcept {
  const auto tiles = state_->undo[0].redo();
  state_->coverage[0].touch(tiles);
  return !tiles.empty();
}

void Painter::clear() noexcept {
  glBindFramebuffer(GL_FRAMEBUFFER, state_->framebuffer.id());
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  state_->undo[0].forget_all();
  state_->coverage[0].touch_all();
}

double Painter::coverage() noexcept {
  return state_->coverage[0].update();
}

AtlasPicture Painter::read_back() const {
  AtlasPicture picture{.width_texels = state_->layout->width_texels,
                       .height_texels = state_->layout->height_texels};
  picture.rgba.resize(4 * static_cast<std::size_t>(picture.width_texels) *
                      static_cast<std::size_t>(picture.height_texels));
  glBindFramebuffer(GL_FRAMEBUFFER, state_->framebuffer.id());
  glReadPixels(0, 0, picture.width_texels, picture.height_texels, GL_RGBA, GL_UNSIGNED_BYTE,
               picture.rgba.data());
  for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
    const unsigned alpha = picture.rgba[i + 3];
    if (alpha == 0 || alpha == 255) continue;
    for (std::size_t c = i; c < i + 3; ++c) {
      picture.rgba[c] =
          static_cast<std::uint8_t>(std::min(255u, (picture.rgba[c] * 255u + alpha / 2) / alpha));
    }
  }
  return picture;
}

std::uint32_t Painter::atlas_texture() const noexcept {
  return state_->atlas.id();
}
const gles::PictureTexture& Painter::picture() const noexcept {
  return state_->picture[0];
}

}  // namespace orcart
