// Reads DICOM with GDCM; everything it says is checked before it is believed.
#include "tools/volume/dicom_files.hpp"

#include <gdcmReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <numeric>
#include <set>

#include "firmware-host/files/whole_file.hpp"
#include "tools/volume/dicom_bytes.hpp"
#include "tools/volume/dicom_elements.hpp"
#include "tools/volume/dicom_frames.hpp"
#include "tools/volume/dicom_pixels.hpp"
#include "tools/volume/voxel_numbers.hpp"

namespace orcart {

namespace {

constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{1} << 31U;

std::string variant_of(const gdcm::DataSet& set) {
  std::string variant;
  const auto add = [&](const char* name, std::uint16_t group, std::uint16_t element) {
    const std::string value = text_at(set, {group, element});
    if (!value.empty()) variant += (variant.empty() ? "" : ", ") + (name + (" " + value));
  };
  add("time", 0x0020, 0x0100);
  add("echo", 0x0018, 0x0086);
  return variant;
}

/// What a file says of all its frames.
DicomSlice slice_of(const std::filesystem::path& file, const gdcm::DataSet& set) {
  DicomSlice slice{.file = file};
  slice.patient =
      std::hash<std::string>{}(text_at(set, {0x0010, 0x0020}) + "|" + text_at(set, {0x0010, 0x0010}) + "|" +
                               text_at(set, {0x0010, 0x0030}));
  slice.instance = text_at(set, {0x0008, 0x0018});
  slice.series = text_at(set, {0x0020, 0x000E});
  slice.frame_of_reference = text_at(set, {0x0020, 0x0052});
  slice.modality = text_at(set, {0x0008, 0x0060});
  slice.variant = variant_of(set);
  slice.acquisition = text_at(set, {0x0020, 0x0012});
  slice.rows = short_at(set, {0x0028, 0x0010});
  slice.columns = short_at(set, {0x0028, 0x0011});
  slice.thickness_mm = number_at(set, {0x0018, 0x0050}, 1);
  slice.slope = number_at(set, {0x0028, 0x1053}, 1);
  slice.intercept = number_at(set, {0x0028, 0x1052}, 0);
  return slice;
}

/// Files that hold one series in parts (a concatenation) are one.
std::string part_of(const std::string& name, const gdcm::DataSet& set) {
  const std::string whole = text_at(set, {0x0020, 0x9161});
  return whole.empty()
             ? name
             : "concatenation ..." + whole.substr(whole.size() - std::min<std::size_t>(whole.size(), 12));
}

bool is_image(const std::vector<DicomSlice>& slices) {
  return !slices.empty() && slices.front().rows > 0 && slices.front().columns > 0;
}

struct Named {
  std::filesystem::path file;
  std::string name;  ///< within the folder
};

Result<std::vector<DicomSlice>> slices_of(const Named& named, const gdcm::DataSet& set) {
  const double frames = number_at(set, {0x0028, 0x0008}, 1);
  DicomSlice slice = slice_of(named.file, set);
  if (frames > 1 || has_frame_groups(set)) {
    slice.part = part_of(named.name, set);
    slice.variant.clear();
    slice.acquisition.clear();
    return frames_of(set, slice, frames);
  }
  slice.facets = facets_of_slice(set);
  const PlaneSets planes{.position = &set, .orientation = &set, .measures = &set};
  if (auto placed = place_slice(planes, slice); !placed) return tl::unexpected(placed.error());
  return std::vector{std::move(slice)};
}

Result<std::vector<DicomSlice>> read_header(const Named& named) {
  const std::string name = named.file.string();
  const auto bytes = read_whole_file(named.file, kMostFileBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto extent = extent_of_dicom({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  if (!extent.whole)
    return fail(name + ": begins as DICOM but is broken or cut short; a whole file is expected");
  std::ifstream stream(named.file, std::ios::binary);
  gdcm::Reader reader;
  reader.SetStream(stream);
  const std::set<gdcm::Tag> no_skipped;
  if (!reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010), no_skipped))
    return fail(name + ": begins as DICOM but cannot be read; it is broken or cut short");
  const gdcm::DataSet& set = reader.GetFile().GetDataSet();
  const int samples = short_at(set, {0x0028, 0x0002});
  auto slices = slices_of(named, set);
  if (!slices || !is_image(*slices)) return slices;
  if (!extent.has_pixels)
    return fail(name + ": states rows and columns but holds no pixels; a whole file is expected");
  if (samples > 4 || samples == 2)
    return fail(name + ": states " + std::to_string(samples) + " samples a pixel; one is accepted");
  return slices;
}

/// A folder in it that cannot be listed is refused: slices would be missing without a word.
Result<std::vector<Named>> files_at(const std::filesystem::path& path) {
  std::vector<Named> files;
  std::error_code error;
  if (!std::filesystem::is_directory(path, error))
    return std::vector<Named>{{.file = path, .name = path.filename().string()}};
  auto entry = std::filesystem::recursive_directory_iterator(path, error);
  std::filesystem::path last = path;
  while (!error && entry != std::filesystem::recursive_directory_iterator()) {
    std::error_code unknown;  // such as a link that leads nowhere
    last = entry->path();
    if (entry->is_regular_file(unknown))
      files.push_back({.file = entry->path(), .name = entry->path().lexically_relative(path).string()});
    entry.increment(error);
  }
  if (error)
    return fail(last.string() + ": cannot be listed: " + error.message() +
                "; slices may lie there, so a folder that can be read whole is expected");
  std::sort(files.begin(), files.end(), [](const Named& a, const Named& b) { return a.file < b.file; });
  return files;
}

}  // namespace

bool is_dicom(const std::filesystem::path& file) {
  std::array<char, 132> start{};
  std::ifstream(file, std::ios::binary).read(start.data(), start.size());
  return begins_as_dicom({start.data(), start.size()});
}

Result<DicomFolder> read_dicom_headers(const std::filesystem::path& path) {
  gdcm::Trace::SetWarning(false);
  gdcm::Trace::SetError(false);
  const auto files = files_at(path);
  if (!files) return tl::unexpected(files.error());
  DicomFolder found;
  std::size_t others = 0;
  for (const auto& named : *files) {
    auto slices = is_dicom(named.file) ? read_header(named) : Result<std::vector<DicomSlice>>();
    if (!slices) return tl::unexpected(slices.error());
    if (is_image(*slices))
      std::move(slices->begin(), slices->end(), std::back_inserter(found.slices));
    else
      ++others;
  }
  if (found.slices.empty())
    return fail(path.string() + ": holds " + std::to_string(files->size()) +
                " files and no DICOM image; a folder with the slices of a series is expected");
  if (others > 0)
    found.notes.push_back(std::to_string(others) + " files beside the slices are no DICOM images");
  return found;
}

Result<Volume> read_stack(const DicomStack& stack, const std::function<void(double done)>& progress) {
  const DicomSlice& first = stack.slices.front();
  Volume volume{.lattice = stack.lattice,
                .values = {},
                .kind = "DICOM " + first.modality + ", " + std::to_string(stack.slices.size()) + " slices",
                .series = first.series,
                .frame_of_reference = first.frame_of_reference,
                .notes = stack.notes};
  const std::size_t layer = static_cast<std::size_t>(first.columns) * static_cast<std::size_t>(first.rows);
  if (layer * stack.slices.size() > kMostVoxels)
    return fail(first.file.parent_path().string() + ": has " + std::to_string(layer * stack.slices.size()) +
                " voxels; up to " + std::to_string(kMostVoxels) + " are accepted");
  volume.values.resize(layer * stack.slices.size());
  std::vector<std::size_t> order(stack.slices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stack.slices[a].file < stack.slices[b].file; });
  std::optional<DicomPixels> pixels;
  for (std::size_t done = 0; done < order.size(); ++done) {
    const DicomSlice& slice = stack.slices[order[done]];
    if (!pixels || slice.file != stack.slices[order[done - 1]].file) {
      pixels.reset();
      auto read = DicomPixels::read(slice.file);
      if (!read) return tl::unexpected(read.error());
      pixels = *std::move(read);
    }
    if (auto taken = pixels->take(slice, volume.values.data() + order[done] * layer); !taken)
      return tl::unexpected(taken.error());
    if (progress) progress(static_cast<double>(done + 1) / static_cast<double>(order.size()));
  }
  return volume;
}

}  // namespace orcart
