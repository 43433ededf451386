// What is on the surface, as the driver has it: colours and the records behind them, painted into side by
// side.
#pragma once

#include "render/atlas/atlas_picture.hpp"
#include "render/atlas/texel_record.hpp"
#include "render/atlas/undo_store.hpp"
#include "render/gles/objects.hpp"

namespace orcart {

/// All calls with the GL context current. Only the two that read back allocate.
class AtlasTextures {
 public:
  AtlasTextures() = default;
  /// Square, bare; fails where the driver cannot draw colours (RGBA8) and records (RGBA16UI) side by side.
  static Result<AtlasTextures> create(int size_texels);

  KeptAtlas kept() const noexcept;
  GLuint colours() const noexcept { return colours_.id(); }
  GLuint records() const noexcept { return records_.id(); }
  /// Colours are target 0 there, records target 1.
  GLuint framebuffer_of_both() const noexcept { return both_.id(); }
  void wipe() noexcept;

  AtlasPicture read_colours() const;
  AtlasRecords read_records() const;

 private:
  int size_texels_ = 0;
  gles::Texture colours_, records_;
  gles::Framebuffer of_colours_, of_records_;  ///< each alone
  gles::Framebuffer both_;
};

}  // namespace orcart
