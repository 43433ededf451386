// A paint pass: depth of the cutout from the scope, then one quad per touched cell of the atlas through the
// paint shader.
#include "render/atlas/painter.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "render/atlas/atlas_textures.hpp"
#include "render/atlas/coverage_counter.hpp"
#include "render/atlas/paint_program.hpp"
#include "render/atlas/scope_depth.hpp"
#include "render/atlas/software/processor_texels.hpp"
#include "render/atlas/surface_textures.hpp"
#include "render/atlas/touched_cells.hpp"
#include "render/atlas/undo_store.hpp"
#include "render/atlas/view_light.hpp"
#include "render/gles/picture_texture.hpp"

namespace orcart {
namespace {

constexpr int kMaskRow = 2048;  // words in a row of the paper mode's triangle mask
const Eigen::AlignedBox3f kEverything(Eigen::Vector3f::Constant(-1e9F), Eigen::Vector3f::Constant(1e9F));

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
  // All but by_processor are there once create() is done.
  std::optional<ScopeDepth> depth;
  std::optional<UndoStore> undo;
  std::optional<CoverageCounter> coverage;
  std::optional<gles::PictureTexture> picture;
  std::optional<TouchedCells> touched_cells;
  std::unique_ptr<ProcessorTexels> by_processor;  ///< where the processor paints
  AtlasTextures atlas;
  gles::Texture mask;                  ///< paper mode's triangles, a bit each
  std::vector<PaintProgram> programs;  ///< by TextureMode
  gles::VertexArray vertex_array;
  gles::Buffer rects;

  std::vector<ChartRect> quads;
  std::vector<std::uint32_t> mask_words;
  const TriangleMesh* mesh = nullptr;
  std::array<Eigen::AlignedBox3f, 16> touched{};  ///< by change number, modulo
  std::uint64_t changes = 0;
  Eigen::AlignedBox3f view_box;  ///< of the view's triangles
  std::uint32_t unit = 0;        ///< of the view
  std::uint32_t kept_unit = 0;   ///< whose tiles were kept last
  PaintView view;
  TextureMode mode = TextureMode::perspective;
  ViewLight light;

  Result<void> make_programs();
  Result<void> make_atlas(const Surface& surface);
  void make_picture();
  void collect(const CutoutPatch& patch, const Pose<C, M>& X_CM) noexcept;
  PaintReport paint_some() noexcept;
  void paint_by_gpu(std::span<const std::uint32_t> cells) noexcept;
  void changed(std::span<const std::uint32_t> tiles) noexcept;
  /// Before the driver reads or changes the atlas.
  void settle() const noexcept {
    if (by_processor) by_processor->send();
  }
  bool processor_paints() const noexcept { return by_processor && mode == TextureMode::perspective; }
  void note_change(const Eigen::AlignedBox3f& box) noexcept { touched[++changes % touched.size()] = box; }
};

Result<void> Painter::State::make_programs() {
  const PaintChoices choices = choices_of(scope, settings);
  for (const TextureMode each : {TextureMode::perspective, TextureMode::paper}) {
    auto made = PaintProgram::create(each, choices, layout->width_texels);
    if (!made) return tl::unexpected(made.error());
    programs.push_back(std::move(*made));
  }
  view.depth_texture = depth->texture();
  view.mask_texture = mask.id();
  view.before_texture = undo->before_texture();
  view.uniforms = uniforms_of(scope, settings, layout->texel_mm, depth->pinhole());
  return {};
}

void Painter::State::make_picture() {
  using Keeps = gles::PicturePyramid::Keeps;
  const PictureCopy copy = by_processor ? PictureCopy::cpu : settings.picture_copy;
  picture.emplace(scope.width_px, scope.height_px, copy,
                  by_processor ? Keeps::all_levels : Keeps::coarser_levels);
}

Result<void> Painter::State::make_atlas(const Surface& from) {
  const std::vector<float> points = texel_points(from.mesh, *layout);
  surface = make_surface_textures(from.mesh, *layout, points);
  auto textures = AtlasTextures::create(layout->width_texels);
  if (!textures) return tl::unexpected(textures.error());
  atlas = std::move(*textures);
  if (settings.paint_by == PaintBy::processor)
    by_processor = std::make_unique<ProcessorTexels>(from.mesh, atlas.kept(), depth->pinhole(),
                                                     choices_of(scope, settings), points);
  const std::size_t words = (from.mesh.triangles.size() + 31) / 32;
  const int rows = static_cast<int>((words + kMaskRow - 1) / kMaskRow);
  mask_words.assign(static_cast<std::size_t>(rows) * kMaskRow, 0);
  mask = gles::make_texture({GL_R32UI, kMaskRow, rows});

  vertex_array = gles::make_vertex_array();
  glBindVertexArray(vertex_array.id());
  touched_cells.emplace(*layout);
  const std::size_t cell_count = touched_cells->most_cells();
  rects = gles::make_buffer(GL_ARRAY_BUFFER, cell_count * sizeof(ChartRect), nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_UNSIGNED_SHORT, GL_FALSE, sizeof(ChartRect), nullptr);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);

  quads.reserve(cell_count);
  auto store = UndoStore::create(atlas.kept(), settings.undo_units);
  if (!store) return tl::unexpected(store.error());
  undo = std::move(*store);
  const auto texels = static_cast<std::uint64_t>(std::count(layout->inside.begin(), layout->inside.end(), 1));
  auto counter = CoverageCounter::create(atlas.kept(), surface.owner.id(), texels);
  if (!counter) return tl::unexpected(counter.error());
  coverage = std::move(*counter);
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
  state->depth = std::move(*depth);
  if (auto made = state->make_atlas(surface); !made) return tl::unexpected(made.error());
  state->make_picture();
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
  s.make_picture();
}

Painter::Painter(std::unique_ptr<State> state) : state_(std::move(state)) {}
Painter::Painter(Painter&&) noexcept = default;
Painter& Painter::operator=(Painter&&) noexcept = default;
Painter::~Painter() = default;

bool Painter::upload(const ImageDescriptor& image) noexcept {
  return state_->picture->upload(image);
}

void Painter::State::collect(const CutoutPatch& patch, const Pose<C, M>& X_CM) noexcept {
  if (patch.first_part) {
    touched_cells->begin();
    view_box.setEmpty();
    set_pose(view.uniforms, X_CM);
    mode = patch.mode;
    view.paper = patch.paper;
    light.begin(patch.X_MC, scope);
    if (mode == TextureMode::paper) std::fill(mask_words.begin(), mask_words.end(), 0u);
  }
  if (settings.light == LightModel::auto_exposure) light.add(*mesh, patch.triangles);
  for (const std::uint32_t triangle : patch.triangles) {
    if (mode == TextureMode::paper) mask_words[triangle >> 5] |= 1u << (triangle & 31);
    touched_cells->add(triangle);
    for (const std::uint32_t corner : mesh->triangles[triangle]) view_box.extend(mesh->vertices_mm[corner]);
  }
}

PaintReport Painter::paint(const CutoutPatch& patch, std::uint32_t unit) noexcept {
  State& s = *state_;
  if (s.picture->empty() || (patch.mode == TextureMode::paper && !patch.paper.valid)) return {};
  const Pose<C, M> X_CM = patch.X_MC.inverse();
  s.collect(patch, X_CM);
  s.unit = unit;
  s.view.uniforms.u_capture = static_cast<float>(capture_number(unit));
  if (s.processor_paints())
    s.by_processor->see(patch, X_CM);
  else if (patch.mode == TextureMode::perspective)
    s.depth->draw(patch, X_CM);
  if (!patch.last_part) return {};
  s.view.uniforms.u_light.z = s.settings.light == LightModel::auto_exposure ? s.light.mean() : 1.0F;
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
  TouchedCells& touches = *touched_cells;
  const std::span<const std::uint32_t> cells = touches.next(settings.max_texels_per_step);
  const PaintReport report{.painted = !cells.empty(),
                           .carried = touches.more(),
                           .texels = static_cast<std::uint32_t>(cells.size() * kCellTexels * kCellTexels)};
  if (!report.painted) return report;
  note_change(view_box);
  if (unit != kept_unit || !processor_paints()) settle();  // else tiles not kept yet are not painted since
  kept_unit = unit;
  undo->keep(unit, touches.tiles());
  if (processor_paints()) {
    by_processor->paint(cells, touches.tiles(), view.uniforms, picture->in_memory());
    coverage->touch(touches.tiles());
  } else {
    undo->show_before(touches.tiles());
    paint_by_gpu(cells);
    changed(touches.tiles());
  }
  return report;
}

/// Other than by the processor's painting.
void Painter::State::changed(std::span<const std::uint32_t> tiles) noexcept {
  coverage->touch(tiles);
  if (by_processor) by_processor->forget(tiles);
}

void Painter::State::paint_by_gpu(std::span<const std::uint32_t> cells) noexcept {
  const std::uint32_t cells_per_row = touched_cells->cells_per_row();
  quads.clear();
  for (const std::uint32_t cell : cells) {
    quads.push_back({static_cast<std::uint16_t>(cell % cells_per_row * kCellTexels),
                     static_cast<std::uint16_t>(cell / cells_per_row * kCellTexels), kCellTexels,
                     kCellTexels});
  }
  glBindFramebuffer(GL_FRAMEBUFFER, atlas.framebuffer_of_both());
  glViewport(0, 0, layout->width_texels, layout->height_texels);
  glEnable(GL_BLEND);  // colours alone: records are integers
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  programs[static_cast<std::size_t>(mode)].use(view, surface, *picture);
  glBindVertexArray(vertex_array.id());
  glBindBuffer(GL_ARRAY_BUFFER, rects.id());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(quads.size() * sizeof(ChartRect)),
                  quads.data());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(quads.size()));
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

bool Painter::undo() noexcept {
  state_->note_change(kEverything);
  state_->settle();
  const auto tiles = state_->undo->undo();
  state_->changed(tiles);
  return !tiles.empty();
}

bool Painter::redo() noexcept {
  state_->note_change(kEverything);
  state_->settle();
  const auto tiles = state_->undo->redo();
  state_->changed(tiles);
  return !tiles.empty();
}

void Painter::clear() noexcept {
  state_->note_change(kEverything);
  state_->atlas.wipe();
  if (state_->by_processor) state_->by_processor->clear();
  state_->undo->forget_all();
  state_->coverage->touch_all();
}

double Painter::coverage() noexcept {
  state_->settle();
  return state_->coverage->update();
}

AtlasPicture Painter::read_back() const {
  state_->settle();
  return state_->atlas.read_colours();
}

AtlasRecords Painter::read_records() const {
  state_->settle();
  return state_->atlas.read_records();
}

void Painter::set_turn(double turn_rad) noexcept {
  set_optics(state_->view.uniforms, optics_at(state_->scope, turn_rad));
}

void Painter::set_view_error(const ViewError& error) noexcept {
  state_->view.uniforms.u_view_error = {error.position_mm, error.angle_rad, error.pixels};
}

std::uint64_t Painter::changes() const noexcept {
  return state_->changes;
}

Eigen::AlignedBox3f Painter::touched_by(std::uint64_t change) const noexcept {
  const State& s = *state_;
  const bool remembered = change > 0 && change <= s.changes && s.changes - change < s.touched.size();
  return remembered ? s.touched[change % s.touched.size()] : kEverything;
}

PaintedAtlas Painter::painted(PaintBy drawn_by) const noexcept {
  const State& s = *state_;
  PaintedAtlas atlas;
  if (drawn_by == PaintBy::gpu) {
    s.settle();
    atlas.colour_texture = s.atlas.colours();
    atlas.record_texture = s.atlas.records();
  } else if (s.by_processor) {
    const TexelMemory& memory = s.by_processor->up_to_date();
    atlas.colours = memory.colours;
    atlas.records = memory.records;
    atlas.width_texels = memory.width_texels;
  }
  return atlas;
}

PictureCopy Painter::picture_copy() const noexcept {
  return state_->picture->copy();
}

const gles::PictureTexture& Painter::picture() const noexcept {
  return *state_->picture;
}

}  // namespace orcart
