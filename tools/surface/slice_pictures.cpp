// Slices along the volume's own axes, turned so that they lie as a person expects.
#include "tools/surface/slice_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace orcart {

namespace {

/// How a slice lies on the picture: which volume axis runs right and which down, and whether reversed.
struct SliceFrame {
  std::size_t across = 2, right = 0, down = 1;
  bool right_reversed = false, down_reversed = false;
};

/// The LPS axis that a step runs along most, and whether it runs against it.
std::pair<std::size_t, bool> main_axis(const PlainPoint& step) {
  std::size_t axis = 0;
  for (std::size_t row = 1; row < 3; ++row)
    if (std::abs(step[row]) > std::abs(step[axis])) axis = row;
  return {axis, step[axis] < 0};
}

/// x runs right and y down in LPS (patient's left at the right, back below); z runs up.
SliceFrame frame_across(const VoxelLattice& lattice, std::size_t across) {
  SliceFrame frame{.across = across, .right = (across + 1) % 3, .down = (across + 2) % 3};
  const auto lps = [&](std::size_t axis) { return main_axis(lattice.step_mm[axis]); };
  if (lps(frame.right).first > lps(frame.down).first) std::swap(frame.right, frame.down);
  frame.right_reversed = lps(frame.right).second;
  frame.down_reversed = lps(frame.down).second != (lps(frame.down).first == 2);
  return frame;
}

class SliceDrawing {
 public:
  SliceDrawing(const Volume& volume, std::size_t across, int index)
      : volume_(volume), frame_(frame_across(volume.lattice, across)), index_(index) {
    const double right_mm = step_length_mm(volume.lattice, static_cast<int>(frame_.right)),
                 down_mm = step_length_mm(volume.lattice, static_cast<int>(frame_.down));
    const double width_mm = right_mm * size(frame_.right), height_mm = down_mm * size(frame_.down);
    constexpr double kLongest = 512;
    pixels_a_mm_ = kLongest / std::max(width_mm, height_mm);
    picture_.width_px = std::max(1, static_cast<int>(std::lround(width_mm * pixels_a_mm_)));
    picture_.height_px = std::max(1, static_cast<int>(std::lround(height_mm * pixels_a_mm_)));
    voxel_a_pixel_right_ = size(frame_.right) / static_cast<double>(picture_.width_px);
    voxel_a_pixel_down_ = size(frame_.down) / static_cast<double>(picture_.height_px);
    paint_grey();
  }

  void outline(const TriangleMesh& mesh) {
    std::vector<Eigen::Vector3d> indices;
    indices.reserve(mesh.vertices_mm.size());
    for (const auto& vertex : mesh.vertices_mm) {
      const auto index =
          index_at(volume_.lattice, {static_cast<double>(vertex.x()), static_cast<double>(vertex.y()),
                                     static_cast<double>(vertex.z())});
      indices.emplace_back(index[0], index[1], index[2]);
    }
    const auto side = [&](std::uint32_t v) {
      return indices[v][static_cast<Eigen::Index>(frame_.across)] - index_ - 1e-4;
    };
    for (const auto& t : mesh.triangles) {
      std::vector<Eigen::Vector3d> cuts;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if ((side(a) < 0) == (side(b) < 0)) continue;
        cuts.push_back(indices[a] + side(a) / (side(a) - side(b)) * (indices[b] - indices[a]));
      }
      if (cuts.size() == 2) line(cuts[0], cuts[1]);
    }
  }

  Picture picture() { return std::move(picture_); }

 private:
  double size(std::size_t axis) const { return volume_.lattice.size[axis]; }

  float voxel(int right, int down) const {
    std::array<std::size_t, 3> at{};
    at[frame_.across] = static_cast<std::size_t>(index_);
    at[frame_.right] = static_cast<std::size_t>(right);
    at[frame_.down] = static_cast<std::size_t>(down);
    const auto nx = static_cast<std::size_t>(volume_.lattice.size[0]),
               ny = static_cast<std::size_t>(volume_.lattice.size[1]);
    return volume_.values[at[0] + nx * (at[1] + ny * at[2])];
  }

  int voxel_of(double pixel, double scale, std::size_t axis, bool reversed) const {
    const int index = std::min(static_cast<int>((pixel + 0.5) * scale), volume_.lattice.size[axis] - 1);
    return reversed ? volume_.lattice.size[axis] - 1 - index : index;
  }

  void paint_grey() {
    std::vector<float> greys;
    for (int y = 0; y < picture_.height_px; ++y)
      for (int x = 0; x < picture_.width_px; ++x)
        greys.push_back(voxel(voxel_of(x, voxel_a_pixel_right_, frame_.right, frame_.right_reversed),
                              voxel_of(y, voxel_a_pixel_down_, frame_.down, frame_.down_reversed)));
    std::vector<float> sorted = greys;
    std::sort(sorted.begin(), sorted.end());
    const float low = sorted[sorted.size() / 100], high = sorted[sorted.size() * 99 / 100];
    picture_.rgba.reserve(greys.size() * 4);
    for (const float grey : greys) {
      const float part = high > low ? std::clamp((grey - low) / (high - low), 0.0F, 1.0F) : 0.5F;
      const auto byte = static_cast<std::uint8_t>(255 * part);
      picture_.rgba.insert(picture_.rgba.end(), {byte, byte, byte, 255});
    }
  }

  /// Where an index lies on the picture, pixels.
  Eigen::Vector2d pixel_of(const Eigen::Vector3d& index) const {
    double right = index[static_cast<Eigen::Index>(frame_.right)],
           down = index[static_cast<Eigen::Index>(frame_.down)];
    if (frame_.right_reversed) right = size(frame_.right) - 1 - right;
    if (frame_.down_reversed) down = size(frame_.down) - 1 - down;
    return {(right + 0.5) / voxel_a_pixel_right_ - 0.5, (down + 0.5) / voxel_a_pixel_down_ - 0.5};
  }

  void line(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const Eigen::Vector2d from = pixel_of(a), to = pixel_of(b);
    const int steps = static_cast<int>((to - from).cwiseAbs().maxCoeff() * 2) + 1;
    for (int i = 0; i <= std::min(steps, 4000); ++i) {
      const Eigen::Vector2d at = from + (to - from) * i / steps;
      const auto x = std::lround(at.x()), y = std::lround(at.y());
      if (x < 0 || y < 0 || x >= picture_.width_px || y >= picture_.height_px) continue;
      std::uint8_t* pixel = picture_.rgba.data() +
                            4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture_.width_px) +
                                 static_cast<std::size_t>(x));
      pixel[0] = 255;
      pixel[1] = 205;
      pixel[2] = 0;
    }
  }

  const Volume& volume_;
  SliceFrame frame_;
  int index_;
  double pixels_a_mm_ = 1, voxel_a_pixel_right_ = 1, voxel_a_pixel_down_ = 1;
  Picture picture_;
};

}  // namespace

std::array<SlicePicture, 3> draw_slices(const Volume& volume, const TriangleMesh& mesh,
                                        const PlainPoint& through_mm) {
  const auto index = index_at(volume.lattice, through_mm);
  std::array<SlicePicture, 3> slices;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int at = std::clamp(static_cast<int>(std::lround(index[axis])), 0, volume.lattice.size[axis] - 1);
    std::array<double, 3> centre{};
    for (std::size_t i = 0; i < 3; ++i) centre[i] = (volume.lattice.size[i] - 1) / 2.0;
    centre[axis] = at;
    const std::size_t lps = main_axis(volume.lattice.step_mm[axis]).first;
    SliceDrawing drawing(volume, axis, at);
    drawing.outline(mesh);
    slices[axis] = {.picture = drawing.picture(),
                    .across = static_cast<char>('x' + static_cast<int>(lps)),
                    .index = at,
                    .place_mm = place_of(volume.lattice, centre)[lps]};
  }
  return slices;
}

}  // namespace orcart
