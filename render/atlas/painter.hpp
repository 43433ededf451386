// Puts pictures onto the surface: the atlas on the GPU, painted texel by texel, with undo that restores exact
// bytes.
#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Geometry>

#include "realtime/base/image.hpp"
#include "realtime/base/result.hpp"
#include "realtime/geometry/triangle_mesh.hpp"
#include "realtime/mapper/cutout_patch.hpp"
#include "realtime/optics/scope_model.hpp"
#include "render/atlas/atlas_layout.hpp"
#include "render/atlas/atlas_picture.hpp"
#include "render/atlas/paint_settings.hpp"
#include "render/atlas/texel_record.hpp"

namespace orcart {

struct PaintReport {
  bool painted = false;
  bool carried = false;      ///< the texel cap was reached; call paint_more()
  std::uint32_t texels = 0;  ///< that were gone through
};

/// What is on the surface, where it was asked for.
struct PaintedAtlas {
  std::uint32_t colour_texture = 0;  ///< GL name, RGBA8, premultiplied by alpha
  std::uint32_t record_texture = 0;  ///< GL name, RGBA16UI, a TexelRecord each
  // In memory, row 0 first; none where the processor does not paint.
  const std::uint32_t* colours = nullptr;  ///< the first channel in the lowest byte
  const TexelRecord* records = nullptr;
  int width_texels = 0;
};

namespace gles {
class PictureTexture;
}

/// All calls from the thread whose GL context is current. After create() our own code allocates nothing but
/// in read_back() and read_records(); the driver may.
class Painter {
 public:
  static Result<Painter> create(const Surface& surface, const AtlasLayout& layout, const ScopeModel& scope,
                                const PainterSettings& settings);
  Painter(Painter&&) noexcept;
  Painter& operator=(Painter&&) noexcept;
  ~Painter();

  /// Takes a picture over to the GPU; it is what paint() paints and what the inset shows. False where its
  /// size is not the scope's or its format is unknown: the last picture stays.
  bool upload(const ImageDescriptor& image) noexcept;
  /// Paints the uploaded picture onto the patch's triangles, by the policy of the settings. Pictures with the
  /// same unit are undone together. Of a view in parts, only the last part paints: by then all that hides is
  /// known.
  PaintReport paint(const CutoutPatch& patch, std::uint32_t unit) noexcept;
  /// Goes on where the texel cap stopped the paint() before, with the picture that is uploaded now.
  PaintReport paint_more() noexcept;
  /// Takes back the newest unit (true), byte by byte; false where there is none left.
  bool undo() noexcept;
  bool redo() noexcept;
  void clear() noexcept;

  /// Share of the surface's own texels (gutters not counted) that carry paint, 0..1. Cheap; call at most a
  /// few times a second.
  double coverage() noexcept;
  AtlasPicture read_back() const;
  AtlasRecords read_records() const;
  /// How far the light post is turned in the next views, since the turn of the passport that was given; 0 at
  /// first.
  void set_turn(double turn_rad) noexcept;
  /// What the next views' poses are worth; at first what the passport's residuals say. Allocates nothing.
  void set_view_error(const ViewError& error) noexcept;

  /// How often the atlas was changed so far, and the box of M (mm) that holds what the n-th change touched (1
  /// is the first). The newest 16 are remembered; older ones, and steps back and forth, may have touched
  /// everything.
  std::uint64_t changes() const noexcept;
  Eigen::AlignedBox3f touched_by(std::uint64_t change) const noexcept;

  /// For who draws it, until the next change.
  PaintedAtlas painted(PaintBy drawn_by) const noexcept;
  const gles::PictureTexture& picture() const noexcept;  ///< the newest upload
  PictureCopy picture_copy() const noexcept;             ///< as it ended up

 private:
  void warm_up();

  struct State;
  std::unique_ptr<State> state_;
  explicit Painter(std::unique_ptr<State> state);
};

}  // namespace orcart
