// Closing, resampling and smoothing through ITK.
#include "tools/surface/soft_region.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <itkBinaryBallStructuringElement.h>
#include <itkBinaryMorphologicalClosingImageFilter.h>
#include <itkDiscreteGaussianImageFilter.h>
#include <itkImage.h>
#include <itkLinearInterpolateImageFunction.h>
#include <itkResampleImageFilter.h>

namespace orcart {

namespace {

using Field = itk::Image<float, 3>;
using Mask = itk::Image<std::uint8_t, 3>;

constexpr double kMostGridPoints = 200e6;

template <class Image>
void lie_on(Image& image, const VoxelLattice& lattice) {
  typename Image::PointType origin;
  typename Image::SpacingType spacing;
  typename Image::DirectionType direction;
  for (unsigned axis = 0; axis < 3; ++axis) {
    origin[axis] = lattice.origin_mm[axis];
    spacing[axis] = step_length_mm(lattice, static_cast<int>(axis));
    for (unsigned row = 0; row < 3; ++row) direction(row, axis) = lattice.step_mm[axis][row] / spacing[axis];
  }
  image.SetOrigin(origin);
  image.SetSpacing(spacing);
  image.SetDirection(direction);
}

/// The region's box with `margin` voxels around it, beyond the volume where need be; indices stay the
/// volume's.
Mask::Pointer cut_out(const GrownRegion& region, const VoxelLattice& lattice,
                      const std::array<int, 3>& margin) {
  Mask::RegionType box;
  for (unsigned axis = 0; axis < 3; ++axis) {
    box.SetIndex(axis, region.count.first[axis] - margin[axis]);
    box.SetSize(axis, static_cast<std::size_t>(region.count.last[axis] - region.count.first[axis] + 1 +
                                               2 * margin[axis]));
  }
  auto mask = Mask::New();
  mask->SetRegions(box);
  lie_on(*mask, lattice);
  mask->Allocate(true);
  const auto nx = static_cast<std::size_t>(lattice.size[0]), ny = static_cast<std::size_t>(lattice.size[1]);
  for (int k = region.count.first[2]; k <= region.count.last[2]; ++k)
    for (int j = region.count.first[1]; j <= region.count.last[1]; ++j) {
      const std::uint8_t* row =
          region.voxels.data() + nx * (static_cast<std::size_t>(j) + ny * static_cast<std::size_t>(k));
      const Mask::IndexType start{{region.count.first[0], j, k}};
      std::copy(row + region.count.first[0], row + region.count.last[0] + 1,
                mask->GetBufferPointer() + mask->ComputeOffset(start));
    }
  return mask;
}

Field::Pointer smooth(const Field::Pointer& field, double sigma_mm) {
  if (sigma_mm <= 0) return field;
  auto gaussian = itk::DiscreteGaussianImageFilter<Field, Field>::New();
  gaussian->SetInput(field);
  gaussian->SetVariance(sigma_mm * sigma_mm);
  gaussian->SetUseImageSpacing(true);
  gaussian->SetMaximumKernelWidth(63);
  gaussian->Update();
  return gaussian->GetOutput();
}

/// Of the ball, in voxels.
std::array<int, 3> radius_of(const VoxelLattice& lattice, double close_mm) {
  std::array<int, 3> radius{};
  for (int axis = 0; axis < 3; ++axis)
    radius[static_cast<std::size_t>(axis)] =
        static_cast<int>(std::lround(close_mm / step_length_mm(lattice, axis)));
  return radius;
}

/// Dilates by a ball and erodes again: fills what is narrower than the ball.
Mask::Pointer close_gaps(const Mask::Pointer& mask, const std::array<int, 3>& radius) {
  using Ball = itk::BinaryBallStructuringElement<std::uint8_t, 3>;
  if (std::max({radius[0], radius[1], radius[2]}) == 0) return mask;
  Ball ball;
  Ball::RadiusType size;
  for (unsigned axis = 0; axis < 3; ++axis) size[axis] = static_cast<std::size_t>(radius[axis]);
  ball.SetRadius(size);
  ball.CreateStructuringElement();
  auto closing = itk::BinaryMorphologicalClosingImageFilter<Mask, Mask, Ball>::New();
  closing->SetInput(mask);
  closing->SetKernel(ball);
  closing->SetForegroundValue(1);
  closing->Update();
  return closing->GetOutput();
}

VoxelGrid grid_of(Mask& mask) {
  const auto size = mask.GetBufferedRegion().GetSize();
  return {.size = {static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2])},
          .voxels = {mask.GetBufferPointer(), mask.GetBufferedRegion().GetNumberOfPixels()}};
}

double step_mm(const Mask& mask, unsigned axis, const SoftRegion& options) {
  return options.grid_mm > 0 ? options.grid_mm : mask.GetSpacing()[axis];
}

double grid_points(const Mask& mask, const VoxelCount& count, const SoftRegion& options) {
  double points = 1;
  for (unsigned axis = 0; axis < 3; ++axis)
    points *=
        (count.last[axis] - count.first[axis] + 8) * mask.GetSpacing()[axis] / step_mm(mask, axis, options);
  return points;
}

/// The part of the mask that holds the region with a margin, as numbers, on the grid asked for.
Field::Pointer resample(const Mask& mask, const VoxelCount& count, const SoftRegion& options) {
  auto spacing = mask.GetSpacing();
  Field::SizeType size;
  itk::ContinuousIndex<double, 3> first;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double margin = 3 * options.smooth_mm / spacing[axis] + 3;
    const double steps = count.last[axis] - count.first[axis] + 2 * margin;
    const double step = step_mm(mask, axis, options);
    first[axis] = static_cast<double>(mask.GetBufferedRegion().GetIndex(axis)) + count.first[axis] - margin;
    size[axis] = static_cast<std::size_t>(std::ceil(steps * spacing[axis] / step)) + 1;
    spacing[axis] = step;
  }
  auto resampling = itk::ResampleImageFilter<Mask, Field>::New();
  resampling->SetInput(&mask);
  resampling->SetSize(size);
  resampling->SetOutputSpacing(spacing);
  resampling->SetOutputDirection(mask.GetDirection());
  resampling->SetOutputOrigin(mask.TransformContinuousIndexToPhysicalPoint<double>(first));
  resampling->SetInterpolator(itk::LinearInterpolateImageFunction<Mask>::New());
  resampling->SetDefaultPixelValue(0);
  resampling->Update();
  return resampling->GetOutput();
}

SoftMask soft_mask_of(const Field& field) {
  SoftMask mask;
  const auto region = field.GetBufferedRegion();
  for (unsigned axis = 0; axis < 3; ++axis) {
    mask.lattice.size[axis] = static_cast<int>(region.GetSize()[axis]);
    mask.lattice.origin_mm[axis] = field.GetOrigin()[axis];
    for (unsigned row = 0; row < 3; ++row)
      mask.lattice.step_mm[axis][row] = field.GetDirection()(row, axis) * field.GetSpacing()[axis];
  }
  mask.values.assign(field.GetBufferPointer(), field.GetBufferPointer() + region.GetNumberOfPixels());
  const auto [nx, ny, nz] = mask.lattice.size;
  std::size_t at = 0;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i, ++at)
        if (i == 0 || j == 0 || k == 0 || i == nx - 1 || j == ny - 1 || k == nz - 1) mask.values[at] = 0;
  return mask;
}

Result<SoftenedRegion> soften_with_itk(GrownRegion region, const VoxelLattice& lattice,
                                       const SoftRegion& options, const std::string& name) {
  constexpr int kSpare = 2;
  const auto radius = radius_of(lattice, options.close_mm);
  const Mask::Pointer cut =
      cut_out(region, lattice, {radius[0] + kSpare, radius[1] + kSpare, radius[2] + kSpare});
  const std::size_t raw = region.count.voxels;
  region.voxels = {};
  const Mask::Pointer mask = close_gaps(cut, radius);
  fill_cavities(grid_of(*mask));
  const VoxelCount count = count_voxels(grid_of(*mask));
  if (grid_points(*mask, count, options) > kMostGridPoints)
    return fail(name + ": a grid of " + std::to_string(options.grid_mm) +
                " mm takes more than 200 million points for this region; a coarser --grid is expected");
  return SoftenedRegion{.mask = soft_mask_of(*smooth(resample(*mask, count, options), options.smooth_mm)),
                        .volume_ml = static_cast<double>(count.voxels) * std::abs(voxel_mm3(lattice)) / 1000,
                        .filled_voxels = count.voxels - raw};
}

tl::unexpected<Error> failed(const std::string& name, const itk::ExceptionObject& error) {
  std::string said = error.GetDescription();
  std::replace(said.begin(), said.end(), '\n', ' ');
  return fail(name + ": its region cannot be smoothed: " + said);
}

}  // namespace

Result<void> denoise(Volume& volume, double sigma_mm, const std::string& name) {
  if (sigma_mm <= 0) return {};
  try {
    auto field = Field::New();
    Field::RegionType box;
    for (unsigned axis = 0; axis < 3; ++axis)
      box.SetSize(axis, static_cast<std::size_t>(volume.lattice.size[axis]));
    field->SetRegions(box);
    lie_on(*field, volume.lattice);
    field->Allocate();
    std::copy(volume.values.begin(), volume.values.end(), field->GetBufferPointer());
    const auto smoothed = smooth(field, sigma_mm);
    std::copy_n(smoothed->GetBufferPointer(), volume.values.size(), volume.values.begin());
    return {};
  } catch (const itk::ExceptionObject& error) {
    return failed(name, error);
  }
}

Result<SoftenedRegion> soften(GrownRegion region, const VoxelLattice& lattice, const SoftRegion& options,
                              const std::string& name) {
  try {
    return soften_with_itk(std::move(region), lattice, options, name);
  } catch (const itk::ExceptionObject& error) {
    return failed(name, error);
  }
}

}  // namespace orcart
