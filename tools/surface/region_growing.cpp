// Region growing through ITK: reads, grows, closes cavities, crops, and smooths.
#include "tools/surface/region_growing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>

#include <itkBinaryBallStructuringElement.h>
#include <itkBinaryMorphologicalClosingImageFilter.h>
#include <itkConnectedThresholdImageFilter.h>
#include <itkDiscreteGaussianImageFilter.h>
#include <itkImageFileReader.h>
#include <itkLinearInterpolateImageFunction.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkResampleImageFilter.h>

#include "tools/surface/cavities.hpp"
#include "tools/surface/plain_bytes.hpp"

namespace orcart {

namespace {

using Volume = itk::Image<float, 3>;
using Mask = itk::Image<std::uint8_t, 3>;

constexpr double kMostGridPoints = 100e6;
constexpr std::uint64_t kMostVoxels = 1'000'000'000;

/// A single file that holds header and voxels; detached voxels could be cut short without a sign.
itk::ImageIOBase::Pointer reader_of(const std::string& file) {
  const auto ends = [&](const char* ending) { return file.ends_with(ending); };
  itk::ImageIOBase::Pointer reader;
  if (ends(".nii") || ends(".nii.gz")) reader = itk::NiftiImageIO::New();
  if (ends(".nrrd")) reader = itk::NrrdImageIO::New();
  if (ends(".mha")) reader = itk::MetaImageIO::New();
  return reader && reader->CanReadFile(file.c_str()) ? reader : nullptr;
}

Result<void> check_header(const std::string& file, const itk::ImageIOBase& io) {
  if (io.GetNumberOfDimensions() != 3)
    return fail(file + ": has " + std::to_string(io.GetNumberOfDimensions()) + " dimensions; 3 are accepted");
  if (io.GetNumberOfComponents() != 1)
    return fail(file + ": has " + std::to_string(io.GetNumberOfComponents()) +
                " numbers a voxel; one intensity is accepted");
  if (static_cast<std::uint64_t>(io.GetImageSizeInPixels()) > kMostVoxels)
    return fail(file + ": has " + std::to_string(io.GetImageSizeInPixels()) + " voxels; up to " +
                std::to_string(kMostVoxels) + " are accepted");
  return {};
}

/// ITK fills what a NIfTI or MetaImage lacks with zeros and says nothing, so the bytes are counted here.
Result<void> check_length(const std::string& file, const itk::ImageIOBase& io) {
  std::string header(4096, '\0');
  std::ifstream(file, std::ios::binary).read(header.data(), static_cast<std::streamsize>(header.size()));
  const bool counts = !file.ends_with(".nrrd") && header.find("CompressedData = True") == std::string::npos;
  const auto bytes = static_cast<std::uint64_t>(io.GetImageSizeInBytes());
  if (!counts || plain_bytes(file, bytes) >= bytes) return {};
  return fail(file + ": holds fewer than the " + std::to_string(bytes) +
              " bytes its header says; it is cut short");
}

Result<Volume::Pointer> read_volume(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (!std::filesystem::is_regular_file(path))
    return fail(file + ": is not there; a volume file is expected");
  const auto io = reader_of(file);
  if (!io)
    return fail(file + ": is no volume; NIfTI (.nii, .nii.gz), .nrrd and MetaImage (.mha) are accepted");
  auto reader = itk::ImageFileReader<Volume>::New();
  reader->SetImageIO(io);
  reader->SetFileName(file);
  reader->UpdateOutputInformation();
  if (auto sound = check_header(file, *io); !sound) return tl::unexpected(sound.error());
  if (auto sound = check_length(file, *io); !sound) return tl::unexpected(sound.error());
  reader->Update();
  return reader->GetOutput();
}

std::string shown(const PlainPoint& point) {
  std::ostringstream out;
  out << "(" << point[0] << ", " << point[1] << ", " << point[2] << ")";
  return out.str();
}

Result<Volume::IndexType> index_of_seed(const Volume& volume, const PlainPoint& seed_mm,
                                        const RegionGrowing& options) {
  Volume::PointType point;
  for (unsigned axis = 0; axis < 3; ++axis) point[axis] = seed_mm[axis];
  Volume::IndexType index;
  const std::string name = options.volume.string() + ": the seed " + shown(seed_mm) + " mm (LPS)";
  if (!volume.TransformPhysicalPointToIndex(point, index))
    return fail(name + " lies outside the volume; a seed inside the region is expected");
  const double intensity = volume.GetPixel(index);
  if (intensity >= options.lowest && intensity <= options.highest) return index;
  std::ostringstream out;
  out << name << " has the intensity " << intensity << "; one from " << options.lowest << " to "
      << options.highest << " is expected";
  return fail(out.str());
}

Volume::Pointer smooth(const Volume::Pointer& field, double sigma_mm) {
  if (sigma_mm <= 0) return field;
  auto gaussian = itk::DiscreteGaussianImageFilter<Volume, Volume>::New();
  gaussian->SetInput(field);
  gaussian->SetVariance(sigma_mm * sigma_mm);
  gaussian->SetUseImageSpacing(true);
  gaussian->SetMaximumKernelWidth(63);
  gaussian->Update();
  return gaussian->GetOutput();
}

Result<Mask::Pointer> grow(const Volume::Pointer& volume, const RegionGrowing& options) {
  auto growing = itk::ConnectedThresholdImageFilter<Volume, Mask>::New();
  growing->SetInput(volume);
  growing->SetLower(static_cast<float>(options.lowest));
  growing->SetUpper(static_cast<float>(options.highest));
  growing->SetReplaceValue(1);
  for (const auto& seed : options.seeds_mm) {
    const auto index = index_of_seed(*volume, seed, options);
    if (!index) return tl::unexpected(index.error());
    growing->AddSeed(*index);
  }
  growing->Update();
  return growing->GetOutput();
}

/// Dilates by a ball and erodes again: fills what is narrower than the ball.
Mask::Pointer close_gaps(const Mask::Pointer& mask, double close_mm) {
  using Ball = itk::BinaryBallStructuringElement<std::uint8_t, 3>;
  if (close_mm <= 0) return mask;
  Ball ball;
  Ball::RadiusType radius;
  for (unsigned axis = 0; axis < 3; ++axis)
    radius[axis] = static_cast<std::size_t>(std::lround(close_mm / mask->GetSpacing()[axis]));
  ball.SetRadius(radius);
  ball.CreateStructuringElement();
  auto closing = itk::BinaryMorphologicalClosingImageFilter<Mask, Mask, Ball>::New();
  closing->SetInput(mask);
  closing->SetKernel(ball);
  closing->SetForegroundValue(1);
  closing->Update();
  return closing->GetOutput();
}

Result<void> check_for_leak(const VoxelCount& count, double volume_ml, const RegionGrowing& options) {
  std::ostringstream out;
  out << options.volume.string() << ": the region grown from " << options.lowest << " to " << options.highest
      << " ";
  if (volume_ml > options.largest_ml) {
    out << "fills " << std::lround(volume_ml)
        << " ml, so it leaked; a narrower --range (a lower HI for dark fluid), or a "
        << "--max-volume over the " << options.largest_ml << " ml that are accepted, is expected";
    return fail(out.str());
  }
  if (count.touches_border) {
    out << "reaches the border of the volume, so it leaked or is cut off; a narrower --range (a lower HI for "
           "dark fluid) "
        << "is expected";
    return fail(out.str());
  }
  return {};
}

/// The part of the mask that holds the region with a margin, as numbers, on the grid asked for.
Volume::Pointer resample(const Mask& mask, const VoxelCount& count, const RegionGrowing& options) {
  auto spacing = mask.GetSpacing();
  Volume::SizeType size;
  itk::ContinuousIndex<double, 3> first;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double margin = 3 * options.smooth_mm / spacing[axis] + 3;
    const double steps = count.last[axis] - count.first[axis] + 2 * margin;
    const double step_mm = options.grid_mm > 0 ? options.grid_mm : spacing[axis];
    first[axis] = count.first[axis] - margin;
    size[axis] = static_cast<std::size_t>(std::ceil(steps * spacing[axis] / step_mm)) + 1;
    spacing[axis] = step_mm;
  }
  auto resampling = itk::ResampleImageFilter<Mask, Volume>::New();
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

SoftMask soft_mask_of(const Volume& field) {
  SoftMask mask;
  const auto region = field.GetBufferedRegion();
  for (unsigned axis = 0; axis < 3; ++axis) {
    mask.size[axis] = static_cast<int>(region.GetSize()[axis]);
    mask.origin_mm[axis] = field.GetOrigin()[axis];
    for (unsigned row = 0; row < 3; ++row)
      mask.step_mm[axis][row] = field.GetDirection()(row, axis) * field.GetSpacing()[axis];
  }
  mask.values.assign(field.GetBufferPointer(), field.GetBufferPointer() + region.GetNumberOfPixels());
  const auto [nx, ny, nz] = mask.size;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        if (i == 0 || j == 0 || k == 0 || i == nx - 1 || j == ny - 1 || k == nz - 1)
          mask.values[static_cast<std::size_t>(i) +
                      static_cast<std::size_t>(nx) * (j + static_cast<std::size_t>(ny) * k)] = 0;
  return mask;
}

double grid_points(const Mask& mask, const VoxelCount& count, const RegionGrowing& options) {
  double points = 1;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double step_mm = options.grid_mm > 0 ? options.grid_mm : mask.GetSpacing()[axis];
    points *= (count.last[axis] - count.first[axis] + 8) * mask.GetSpacing()[axis] / step_mm;
  }
  return points;
}

VoxelGrid grid_of(Mask& mask) {
  const auto size = mask.GetBufferedRegion().GetSize();
  return {.size = {static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2])},
          .voxels = {mask.GetBufferPointer(), mask.GetBufferedRegion().GetNumberOfPixels()}};
}

Result<GrownRegion> grow_with_itk(const RegionGrowing& options) {
  const auto volume = read_volume(options.volume);
  if (!volume) return tl::unexpected(volume.error());
  const auto grown = grow(smooth(*volume, options.denoise_mm), options);
  if (!grown) return tl::unexpected(grown.error());
  const auto spacing = (*grown)->GetSpacing();
  const double voxel_ml = spacing[0] * spacing[1] * spacing[2] / 1000;
  const VoxelCount raw = count_voxels(grid_of(**grown));
  if (auto sound = check_for_leak(raw, static_cast<double>(raw.voxels) * voxel_ml, options); !sound)
    return tl::unexpected(sound.error());
  const Mask::Pointer mask = close_gaps(*grown, options.close_mm);
  fill_cavities(grid_of(*mask));
  const VoxelCount count = count_voxels(grid_of(*mask));
  if (grid_points(*mask, count, options) > kMostGridPoints)
    return fail(options.volume.string() + ": a grid of " + std::to_string(options.grid_mm) +
                " mm takes more than 100 million points for this region; a coarser --grid is expected");
  return GrownRegion{.mask = soft_mask_of(*smooth(resample(*mask, count, options), options.smooth_mm)),
                     .volume_ml = static_cast<double>(count.voxels) * voxel_ml,
                     .voxels = count.voxels,
                     .filled_voxels = count.voxels - raw.voxels};
}

}  // namespace

Result<GrownRegion> grow_region(const RegionGrowing& options) {
  try {
    return grow_with_itk(options);
  } catch (const itk::ExceptionObject& error) {
    std::string said = error.GetDescription();
    std::replace(said.begin(), said.end(), '\n', ' ');
    return fail(options.volume.string() + ": cannot be read as a volume: " + said);
  }
}

}  // namespace orcart
