// Memory in, memory out; GL is given the pixels that changed.
#include "render/views/software/processor_view.hpp"

#include <algorithm>

namespace orcart {
namespace {
constexpr std::size_t kVector = 16;  ///< the longest, in numbers of 32 bits
}

Result<ProcessorView> ProcessorView::create(const ViewMeshes& meshes, const SurfaceViewSettings& settings) {
  ProcessorView self;
  self.settings_ = settings;
  constexpr int kStep = static_cast<int>(kVector);
  self.stride_ = (settings.width_px + kStep - 1) / kStep * kStep;  // vectors that begin in a row end in it
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (!meshes[i].indices.empty()) self.load(meshes[i], self.meshes_[i]);
  self.shown_.resize(self.pixels());
  if (settings.seen_from == SeenFrom::inside) self.shell_.resize(self.pixels());
  self.picture_ = gles::make_texture({GL_RGBA8, settings.width_px, settings.height_px});
  auto framebuffer = gles::make_framebuffer(self.picture_.id());
  if (!framebuffer) return tl::unexpected(framebuffer.error());
  self.framebuffer_ = std::move(*framebuffer);
  return self;
}

std::size_t ProcessorView::pixels() const noexcept {
  return static_cast<std::size_t>(stride_) * static_cast<std::size_t>(settings_.height_px) + 2 * kVector;
}

void ProcessorView::load(const ViewMesh& mesh, Mesh& to) const {
  for (std::size_t k = 0; k < to.numbers.size(); ++k) {
    to.numbers[k].reserve(mesh.vertices.size() + kVector);
    for (const ViewVertex& v : mesh.vertices)
      to.numbers[k].push_back(k < 3 ? v.position[k] : k < 6 ? v.normal[k - 3] : v.texel[k - 6]);
    to.numbers[k].resize(mesh.vertices.size() + kVector);
  }
  to.indices = mesh.indices;
  to.seen.resize(mesh.vertices.size() + kVector);
  to.nearness.resize(pixels());
  to.place.resize(pixels());
  to.light.resize(pixels());
}

PlacePicture ProcessorView::places_of(Mesh& mesh) const noexcept {
  return {.nearness = mesh.nearness.data() + kVector,
          .place = mesh.place.data() + kVector,
          .light = mesh.light.data() + kVector,
          .width = settings_.width_px,
          .height = settings_.height_px,
          .stride = stride_};
}

ViewJob ProcessorView::job_of(Mesh& mesh, const EyeMatrices& from) const noexcept {
  const auto& n = mesh.numbers;
  return {.from = from,
          .near_mm = from.projection[3][2] / (from.projection[2][2] - 1),
          .vertices = {n[0].data(), n[1].data(), n[2].data(), n[3].data(), n[4].data(), n[5].data(),
                       n[6].data(), n[7].data(), n[0].size() - kVector},
          .seen_vertices = mesh.seen.data(),
          .places = places_of(mesh)};
}

void ProcessorView::see(Fineness which, const IndexRange& indices, const EyeMatrices& from) noexcept {
  Mesh& seen = mesh(which);
  ViewJob job = job_of(seen, from);
  job.facing_area = settings_.seen_from == SeenFrom::inside ? 1 : -1;
  if (indices.first == 0) {
    std::fill(seen.nearness.begin(), seen.nearness.end(), 0.0F);
    std::fill(seen.light.begin(), seen.light.end(), 0U);
    see_vertices(job);
  }
  see_triangles(job, std::span(seen.indices).subspan(indices.first, indices.count));
}

void ProcessorView::draw_shell(Fineness which, const EyeMatrices& from) noexcept {
  ViewJob job = job_of(mesh(which), from);
  std::fill(shell_.begin(), shell_.end(), 0U);
  job.shell = shell_.data() + kVector;
  draw_glass(job, mesh(which).indices);
}

void ProcessorView::shade(Fineness which, const PaintedAtlas& paint, const PixelBox& part) noexcept {
  if (paint.colours == nullptr) return;
  shade_pixels({.places = places_of(mesh(which)),
                .paint = paint,
                .colour_by = settings_.colour_by,
                .end_of_ramp = static_cast<float>(end_of_ramp(settings_.colour_by)),
                .shell = shell_.empty() ? nullptr : shell_.data() + kVector,
                .shown = shown_.data() + kVector},
               part);
  glBindTexture(GL_TEXTURE_2D, picture_.id());
  glPixelStorei(GL_UNPACK_ROW_LENGTH, stride_);
  glTexSubImage2D(GL_TEXTURE_2D, 0, part.x, part.y, part.width, part.height, GL_RGBA, GL_UNSIGNED_BYTE,
                  shown_.data() + kVector + part.y * stride_ + part.x);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

}  // namespace orcart
