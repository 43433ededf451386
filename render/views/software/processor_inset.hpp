// The live picture's round inset, drawn by the processor from the picture in memory.
#pragma once

#include <vector>

#include "render/gles/objects.hpp"
#include "render/views/software/inset_job.hpp"

namespace orcart {

/// The thread whose GL context is current. Allocates nothing once made.
class ProcessorInset {
 public:
  /// Where it lies on the panel: its centre and radius, pixels, y down from row 0. `aspect`: fx / fy.
  static Result<ProcessorInset> create(float centre_x, float centre_y, float radius_px, float aspect);

  /// What it lies on from now on.
  void lay_on(GLuint framebuffer) noexcept;
  void draw(const gles::PicturePlanes& picture, const CircularMask& mask, GLuint into) noexcept;

 private:
  ProcessorInset() = default;
  InsetJob job_;
  int x_ = 0, y_ = 0;  ///< of the box on the panel
  std::vector<std::uint32_t> under_, shown_;
  gles::Texture picture_;
  gles::Framebuffer framebuffer_;
};

}  // namespace orcart
