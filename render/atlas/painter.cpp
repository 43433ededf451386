// A paint pass: depth of the cutout from the scope, then one quad per touched cell of the atlas through the
// paint shader.
#include "render/atlas/painter.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "render/atlas/coverage_counter.hpp"
#include "render/atlas/paint_program.hpp"
#include "render/atlas/scope_depth.hpp"
#include "render/atlas/surface_textures.hpp"
#include "render/atlas/undo_store.hpp"
#include "render/atlas/view_light.hpp"
#include "render/gles/picture_texture.hpp"

namespace orcart {
namespace {

constexpr int kMaskRow = 2048;   // words in a row of the paper mode's triangle mask
constexpr int kCellTexels = 16;  // what is painted is drawn in squares of this size
const Eigen::AlignedBox3f kEverything(Eigen::Vector3f::Constant(-1e9F), Eigen::Vector3f::Constant(1e9F));
static_assert(kTileTexels % kCellTexels == 0);

/// Half again as fine as a small picture, about as fine as one of 1080 rows; in steps of 64.
int depth_size_for(const ScopeModel& scope) {
  const int wished = static_cast<int>(std::ceil(1.5 * 2 * scope.mask.radius_px / 64)) * 64;
  return std::clamp(wished, 512, 1024);
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
  gles::Texture atlas, records, mask;
  gles::Framebuffer atlas_framebuffer, record_framebuffer;  ///< each alone
  gles::Framebuffer both;                                   ///< what is painted into
  std::vector<PaintProgram> programs;                       ///< by TextureMode
  gles::VertexArray vertex_array;
  gles::Buffer rects;

  std::vector<std::uint32_t> seen_cell, seen_tile;  ///< epoch of the view, or step, that touched it last
  std::uint32_t epoch = 0, cells_per_row = 0;
  std::vector<std::uint32_t> cells;  ///< of the view, in order; painted up to `painted`
  std::size_t painted = 0;
  std::vector<std::uint32_t> tiles;
  std::vector<ChartRect> quads;
  std::vector<std::uint32_t> mask_words;
  const TriangleMesh* mesh = nullptr;
  std::array<Eigen::AlignedBox3f, 16> touched{};  ///< by change number, modulo
  std::uint64_t changes = 0;
  Eigen::AlignedBox3f view_box;  ///< of the view's triangles
  PaintView view;
  TextureMode mode = TextureMode::perspective;
  ViewLight light;

  KeptAtlas kept() const {
    return {.colour = {atlas.id(), atlas_framebuffer.id()},
            .record = {records.id(), record_framebuffer.id()},
            .size_texels = layout->width_texels};
  }
  Result<void> make_programs();
  Result<void> make_atlas(const Surface& surface);
  Result<void> make_targets();
  void wipe() noexcept;
  void collect(const CutoutPatch& patch) noexcept;
  void collect_cells(std::uint32_t triangle) noexcept;
  void collect_tile(std::uint32_t cell) noexcept;
  PaintReport paint_some() noexcept;
  void note_change(const Eigen::AlignedBox3f& box) noexcept { touched[++changes % touched.size()] = box; }
};

Result<void> Painter::State::make_programs() {
  for (const TextureMode each : {TextureMode::perspective, TextureMode::paper}) {
    auto made = PaintProgram::create(scope, settings,
                                     {.mode = each,
                                      .atlas_size_texels = layout->width_texels,
                                      .texel_mm = layout->texel_mm,
                                      .pinhole = depth[0].pinhole()});
    if (!made) return tl::unexpected(made.error());
    programs.push_back(std::move(*made));
  }
  view.depth_texture = depth[0].texture();
  view.mask_texture = mask.id();
  view.before_texture = undo[0].before_texture();
  view.optics = optics_at(scope, 0);
  view.error = {.position_mm = static_cast<float>(scope.residual_mm),
                .pixels = static_cast<float>(scope.residual_px)};
  return {};
}

Result<void> Painter::State::make_targets() {
  const int width = layout->width_texels, height = layout->height_texels;
  atlas = gles::make_texture({GL_RGBA8, width, height, GL_LINEAR});
  records = gles::make_texture({GL_RGBA16UI, width, height});
  auto of_atlas = gles::make_framebuffer(atlas.id()), of_records = gles::make_framebuffer(records.id());
  if (!of_atlas) return tl::unexpected(of_atlas.error());
  if (!of_records) return tl::unexpected(of_records.error());
  atlas_framebuffer = std::move(*of_atlas);
  record_framebuffer = std::move(*of_records);
  auto of_both = gles::make_framebuffer(atlas.id());
  if (!of_both) return tl::unexpected(of_both.error());
  both = std::move(*of_both);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, records.id(), 0);
  constexpr std::array<GLenum, 2> kTargets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(kTargets.size(), kTargets.data());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return fail("the driver cannot draw colours and records side by side");
  wipe();
  return {};
}

void Painter::State::wipe() noexcept {
  constexpr std::array<GLfloat, 4> kBare{};
  constexpr std::array<GLuint, 4> kNothing{};
  glBindFramebuffer(GL_FRAMEBUFFER, both.id());
  glClearBufferfv(GL_COLOR, 0, kBare.data());
  glClearBufferuiv(GL_COLOR, 1, kNothing.data());
}

Result<void> Painter::State::make_atlas(const Surface& from) {
  surface = make_surface_textures(from.mesh, *layout);
  if (auto made = make_targets(); !made) return made;
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
  state->mesh = &surface.mesh;
  state->scope = scope;
  state->settings = settings;
  constexpr double kWidest = 1.4;  // 80 degrees: beyond, a pinhole depth picture has no resolution left
  if (scope.cone_half_angle_rad > kWidest - 0.03) {
    return fail("the scope's viewing cone is wider than 78 degrees off its axis; the painter takes less");
  }
  const DepthPinhole pinhole{.tangent = static_cast<float>(std::tan(scope.cone_half_angle_rad + 0.03)),
                             .near_mm = 0.3f,
                             .far_mm = static_cast<float>(scope.far_mm * 1.25),
                             .size_texels = depth_size_for(scope)};
  auto depth = ScopeDepth::create(surface.mesh, pinhole);
  if (!depth) return tl::unexpected(depth.error());
  state->depth.push_back(std::move(*depth));
  state->picture.emplace_back(scope.width_px, scope.height_px, settings.picture_copy);
  if (auto made = state->make_atlas(surface); !made) return tl::unexpected(made.error());
  if (auto made = state->make_programs(); !made) return tl::unexpected(made.error());
  Painter painter(std::move(state));
  painter.warm_up();
  return painter;
}

// Software drivers translate a shader when something is first drawn with it, which takes longer than a frame:
// here, not there. The pictures are black and the scope is far away, so nothing is painted.
void Painter::warm_up() {
  State& s = *state_;
  const int width = s.scope.width_px, height = s.scope.height_px;
  std::vector<std::byte> black(packed_bytes(PixelFormat::rgba8888, width, height));
  CutoutPatch patch(1);
  patch.triangles.push_back(0);
  patch.X_MC.translation_mm.setConstant(1e6);
  for (const PixelFormat format : {PixelFormat::yuyv, PixelFormat::nv12, PixelFormat::rgba8888}) {
    upload(packed_image(black.data(), format, width, height));
    paint(patch, 1);
  }
  undo();
  coverage();
  clear();
  s.picture.clear();
  s.picture.emplace_back(width, height, s.settings.picture_copy);
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
    view_box.setEmpty();
    view.X_CM = patch.X_MC.inverse();
    mode = patch.mode;
    view.paper = patch.paper;
    light.begin(patch.X_MC, scope);
    if (mode == TextureMode::paper) std::fill(mask_words.begin(), mask_words.end(), 0u);
  }
  if (settings.light == LightModel::auto_exposure) light.add(*mesh, patch.triangles);
  for (const std::uint32_t triangle : patch.triangles) {
    if (mode == TextureMode::paper) mask_words[triangle >> 5] |= 1u << (triangle & 31);
    collect_cells(triangle);
    for (const std::uint32_t corner : mesh->triangles[triangle]) view_box.extend(mesh->vertices_mm[corner]);
  }
}

PaintReport Painter::paint(const CutoutPatch& patch, std::uint32_t unit) noexcept {
  State& s = *state_;
  if (s.picture[0].empty() || (patch.mode == TextureMode::paper && !patch.paper.valid)) return {};
  s.collect(patch);
  s.view.unit = unit;
  if (patch.mode == TextureMode::perspective) s.depth[0].draw(patch, s.view.X_CM);
  if (!patch.last_part) return {};
  s.view.mean_light = s.settings.light == LightModel::auto_exposure ? s.light.mean() : 1;
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
  note_change(view_box);
  undo[0].keep(view.unit, tiles);
  coverage[0].touch(tiles);
  undo[0].show_before(tiles);
  glBindFramebuffer(GL_FRAMEBUFFER, both.id());
  glViewport(0, 0, layout->width_texels, layout->height_texels);
  glEnable(GL_BLEND);  // colours alone: records are integers
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  programs[static_cast<std::size_t>(mode)].use(view, surface, picture[0]);
  glBindVertexArray(vertex_array.id());
  glBindBuffer(GL_ARRAY_BUFFER, rects.id());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(quads.size() * sizeof(ChartRect)),
                  quads.data());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(quads.size()));
  glBindVertexArray(0);
  glDisable(GL_BLEND);
  return report;
}

bool Painter::undo() noexcept {
  state_->note_change(kEverything);
  const auto tiles = state_->undo[0].undo();
  state_->coverage[0].touch(tiles);
  return !tiles.empty();
}

bool Painter::redo() noexcept {
  state_->note_change(kEverything);
  const auto tiles = state_->undo[0].redo();
  state_->coverage[0].touch(tiles);
  return !tiles.empty();
}

void Painter::clear() noexcept {
  state_->note_change(kEverything);
  state_->wipe();
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
  glBindFramebuffer(GL_FRAMEBUFFER, state_->atlas_framebuffer.id());
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

AtlasRecords Painter::read_records() const {
  AtlasRecords records{.width_texels = state_->layout->width_texels,
                       .height_texels = state_->layout->height_texels};
  records.texels.resize(static_cast<std::size_t>(records.width_texels) *
                        static_cast<std::size_t>(records.height_texels));
  glBindFramebuffer(GL_FRAMEBUFFER, state_->record_framebuffer.id());
  glReadPixels(0, 0, records.width_texels, records.height_texels, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT,
               records.texels.data());
  return records;
}

void Painter::set_turn(double turn_rad) noexcept {
  state_->view.optics = optics_at(state_->scope, turn_rad);
}

void Painter::set_view_error(const ViewError& error) noexcept {
  state_->view.error = error;
}

std::uint64_t Painter::changes() const noexcept {
  return state_->changes;
}

Eigen::AlignedBox3f Painter::touched_by(std::uint64_t change) const noexcept {
  const State& s = *state_;
  const bool remembered = change > 0 && change <= s.changes && s.changes - change < s.touched.size();
  return remembered ? s.touched[change % s.touched.size()] : kEverything;
}

std::uint32_t Painter::atlas_texture() const noexcept {
  return state_->atlas.id();
}
std::uint32_t Painter::record_texture() const noexcept {
  return state_->records.id();
}
PictureCopy Painter::picture_copy() const noexcept {
  return state_->picture[0].copy();
}

const gles::PictureTexture& Painter::picture() const noexcept {
  return state_->picture[0];
}

}  // namespace orcart
