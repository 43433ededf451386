// Chooses the reader by a file's first bytes.
#include "tools/volume/volume_reader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/volume/dicom_files.hpp"
#include "tools/volume/volume_formats.hpp"

namespace orcart {

namespace {

Result<Volume> read_dicom(const VolumeRequest& request, const std::function<void(double)>& progress) {
  const std::string name = request.path.string();
  auto folder = read_dicom_headers(request.path);
  if (!folder) return tl::unexpected(folder.error());
  const bool one_slice = folder->slices.size() == 1 && folder->slices.front().frame == 0;
  if (one_slice && !std::filesystem::is_directory(request.path))
    return fail(name + ": is one DICOM image; the folder that holds the whole series is expected");
  auto stacks = stack_slices(name, std::move(folder->slices));
  if (!stacks) return tl::unexpected(stacks.error());
  auto stack = choose_stack(name, *std::move(stacks), request.stack);
  if (!stack) return tl::unexpected(stack.error());
  stack->notes.insert(stack->notes.end(), folder->notes.begin(), folder->notes.end());
  if (auto sound = check_lattice(name, stack->lattice); !sound) return tl::unexpected(sound.error());
  return read_stack(*stack, progress);
}

Result<Volume> read_file(const VolumeRequest& request) {
  const std::string name = request.path.string();
  auto bytes = read_plain(request.path);
  if (!bytes) return tl::unexpected(bytes.error());
  const VolumeSource source{.file = request.path, .bytes = *bytes, .where_unstated = request.where_unstated};
  if (is_nrrd(*bytes)) return parse_nrrd(source);
  if (is_nifti(*bytes)) return parse_nifti(source);
  if (is_meta_image(*bytes)) return parse_meta_image(source);
  if (is_mgh(*bytes)) return parse_mgh(source);
  return fail(name +
              ": is no volume that says what it holds; DICOM, NIfTI, NRRD, MetaImage and MGH are "
              "accepted (voxels alone need a header beside them: a .mhd with NDims, DimSize, ElementType, "
              "ElementSpacing, Offset, TransformMatrix and ElementDataFile)");
}

void mend_numbers(Volume& volume) {
  float least = std::numeric_limits<float>::infinity();
  std::size_t bad = 0;
  for (const float value : volume.values) {
    if (std::isfinite(value))
      least = std::min(least, value);
    else
      ++bad;
  }
  if (bad == 0) return;
  for (float& value : volume.values)
    if (!std::isfinite(value)) value = std::isfinite(least) ? least : 0;
  volume.notes.push_back(std::to_string(bad) + " voxels hold no number and were set to the least");
}

}  // namespace

Result<Volume> read_volume(const VolumeRequest& request, const std::function<void(double)>& progress) {
  if (!std::filesystem::exists(request.path))
    return fail(request.path.string() +
                ": is not there; a volume file or a folder of DICOM slices is expected");
  const bool dicom = std::filesystem::is_directory(request.path) || is_dicom(request.path);
  auto volume = dicom ? read_dicom(request, progress) : read_file(request);
  if (!volume) return volume;
  if (volume->series.empty()) volume->series = request.path.filename().string();
  mend_numbers(*volume);
  return volume;
}

}  // namespace orcart
