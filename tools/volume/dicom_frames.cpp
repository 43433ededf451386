// Functional groups (DICOM PS3.3, C.7.6.16) taken apart into slices and into what tells frames apart.
#include "tools/volume/dicom_frames.hpp"

#include <algorithm>
#include <array>

#include <cmath>
#include <cstdio>

#include "tools/volume/dicom_elements.hpp"

namespace orcart {

namespace {

using gdcm::DataSet;
using gdcm::Tag;

const Tag kSharedGroups(0x5200, 0x9229), kFrameGroups(0x5200, 0x9230);
const Tag kContent(0x0020, 0x9111), kDiffusion(0x0018, 0x9117);

bool unit_and_square(const std::vector<double>& six) {
  double u = 0, v = 0, uv = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    u += six[i] * six[i];
    v += six[i + 3] * six[i + 3];
    uv += six[i] * six[i + 3];
  }
  return std::abs(u - 1) < 0.01 && std::abs(v - 1) < 0.01 && std::abs(uv) < 0.01;
}

/// What is said of one frame.
struct FrameGroups {
  const DataSet& own;
  const DataSet& shared;

  /// The first item of a group, empty where neither has it.
  DataSet group(const Tag& tag) const {
    for (const DataSet* set : {&own, &shared})
      if (auto items = items_at(*set, tag); !items.empty()) return std::move(items.front());
    return {};
  }
};

enum class Written : std::uint8_t { text, doubles, counts };

std::string written(const DataSet& set, const Tag& tag, Written as) {
  if (as == Written::text) return text_at(set, tag);
  std::string all;
  const auto add = [&](double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", number);
    all += (all.empty() ? "" : " ") + std::string(text);
  };
  if (as == Written::doubles)
    for (const double number : doubles_at(set, tag)) add(number);
  else
    for (const std::uint32_t number : counts_at(set, tag)) add(number);
  return all;
}

struct FacetSource {
  const char* name;
  Tag group, element;
  Written as;
  const char* unit = "";
};

/// The most telling first; delays come late, since some scanners state one for each slice.
const std::vector<FacetSource>& facet_sources() {
  static const std::vector<FacetSource> sources{
      {"image", {0x0018, 0x9226}, {0x0008, 0x9208}, Written::text},  // magnitude, phase, ...
      {"type", {0x0018, 0x9226}, {0x0008, 0x9007}, Written::text},
      {"type", {0x0018, 0x9329}, {0x0008, 0x9007}, Written::text},
      {"type", {0x0018, 0x9751}, {0x0008, 0x9007}, Written::text},
      {"echo", {0x0018, 0x9114}, {0x0018, 0x9082}, Written::doubles, " ms"},
      {"inversion", {0x0018, 0x9115}, {0x0018, 0x9079}, Written::doubles, " ms"},
      {"b", kDiffusion, {0x0018, 0x9087}, Written::doubles, " s/mm2"},
      {"diffusion", kDiffusion, {0x0018, 0x9075}, Written::text},
      {"velocity", {0x0018, 0x9197}, {0x0018, 0x9090}, Written::doubles},
      {"label", {0x0018, 0x9251}, {0x0018, 0x9257}, Written::text},
      {"flip angle", {0x0018, 0x9112}, {0x0018, 0x1314}, Written::text, " degrees"},
      {"tube voltage", {0x0018, 0x9325}, {0x0018, 0x0060}, Written::text, " kV"},
      {"kernel", {0x0018, 0x9314}, {0x0018, 0x1210}, Written::text},
      {"time", kContent, {0x0020, 0x9128}, Written::counts},
      {"delay", {0x0018, 0x9118}, {0x0020, 0x9153}, Written::doubles, " ms"}};
  return sources;
}

/// The names of a file's dimensions, "" for one that is a place: the frames' positions tell that.
std::vector<std::string> dimension_names(const DataSet& set) {
  constexpr std::array kPlaces{0x00200032U, 0x00209056U, 0x00209057U};
  std::vector<std::string> names;
  for (const DataSet& item : items_at(set, {0x0020, 0x9222})) {
    const std::uint32_t pointed = pointer_at(item, {0x0020, 0x9165});
    char number[24];
    std::snprintf(number, sizeof number, "dimension %04X,%04X", pointed >> 16U, pointed & 0xFFFFU);
    const std::string label = text_at(item, {0x0020, 0x9421});
    const bool place = std::find(kPlaces.begin(), kPlaces.end(), pointed) != kPlaces.end();
    names.push_back(place ? "" : label.empty() ? number : label);
  }
  return names;
}

std::vector<Facet> facets_of(const FrameGroups& groups, const std::vector<std::string>& dimensions) {
  std::vector<Facet> facets;
  const auto add = [&](const std::string& name, const std::string& value, const char* unit) {
    if (!value.empty()) facets.push_back({.name = name, .value = value + unit});
  };
  for (const FacetSource& source : facet_sources())
    add(source.name, written(groups.group(source.group), source.element, source.as), source.unit);
  for (const DataSet& direction : items_at(groups.group(kDiffusion), {0x0018, 0x9076}))
    add("direction", written(direction, {0x0018, 0x9089}, Written::doubles), "");
  const DataSet content = groups.group(kContent);
  const auto index = counts_at(content, {0x0020, 0x9157});
  for (std::size_t i = 0; i < std::min(index.size(), dimensions.size()); ++i)
    if (!dimensions[i].empty()) add(dimensions[i], std::to_string(index[i]), "");
  add("acquisition", written(content, {0x0020, 0x9156}, Written::counts), "");
  return facets;
}

Result<DicomSlice> slice_of(DicomSlice slice, const FrameGroups& groups) {
  const DataSet position = groups.group({0x0020, 0x9113}), orientation = groups.group({0x0020, 0x9116}),
                measures = groups.group({0x0028, 0x9110}), transformation = groups.group({0x0028, 0x9145});
  slice.thickness_mm = number_at(measures, {0x0018, 0x0050}, slice.thickness_mm);
  slice.slope = number_at(transformation, {0x0028, 0x1053}, slice.slope);
  slice.intercept = number_at(transformation, {0x0028, 0x1052}, slice.intercept);
  slice.block = text_at(groups.group(kContent), {0x0020, 0x9056});
  const PlaneSets planes{.position = &position, .orientation = &orientation, .measures = &measures};
  if (auto placed = place_slice(planes, slice); !placed) return tl::unexpected(placed.error());
  return slice;
}

}  // namespace

Result<void> place_slice(const PlaneSets& sets, DicomSlice& slice) {
  const Tag at(0x0020, 0x0032), along(0x0020, 0x0037), apart(0x0028, 0x0030);
  const auto position = numbers_at(*sets.position, at, 3), axes = numbers_at(*sets.orientation, along, 6),
             spacing = numbers_at(*sets.measures, apart, 2);
  slice.has_position = position && axes;
  if (!slice.has_position) return {};
  if (!spacing || !((*spacing)[0] > 0 && (*spacing)[1] > 0))
    return fail(name_of(slice) + ": states the PixelSpacing \"" + text_at(*sets.measures, apart) +
                "\"; two positive numbers are expected");
  if (!unit_and_square(*axes))
    return fail(name_of(slice) + ": states the ImageOrientationPatient \"" +
                text_at(*sets.orientation, along) + "\"; two unit vectors at right angles are expected");
  for (std::size_t i = 0; i < 3; ++i) {
    slice.position_mm[i] = (*position)[i];
    slice.along_columns[i] = (*axes)[i];
    slice.along_rows[i] = (*axes)[i + 3];
  }
  slice.row_step_mm = (*spacing)[0];
  slice.column_step_mm = (*spacing)[1];
  return {};
}

std::vector<Facet> facets_of_slice(const DataSet& set) {
  std::vector<Facet> facets{{.name = "type", .value = text_at(set, {0x0008, 0x0008})},
                            {.name = "b", .value = written(set, {0x0018, 0x9087}, Written::doubles)},
                            {.name = "direction", .value = written(set, {0x0018, 0x9089}, Written::doubles)}};
  std::erase_if(facets, [](const Facet& facet) { return facet.value.empty(); });
  return facets;
}

bool has_frame_groups(const DataSet& set) {
  return set.FindDataElement(kFrameGroups);
}

Result<std::vector<DicomSlice>> frames_of(const DataSet& set, const DicomSlice& of_file, double frames) {
  const std::string holds =
      of_file.file.string() + ": holds " + std::to_string(std::lround(frames)) + " frames and ";
  if (!has_frame_groups(set))
    return fail(holds +
                "no functional groups that say where each lies; an enhanced CT or MR, or classic DICOM with "
                "one slice a file, is expected");
  const auto own = items_at(set, kFrameGroups), shared = items_at(set, kSharedGroups);
  if (static_cast<double>(own.size()) != frames)
    return fail(holds + "functional groups for " + std::to_string(own.size()) +
                "; one for each frame is expected");
  const DataSet none;
  const auto dimensions = dimension_names(set);
  std::vector<DicomSlice> slices;
  for (const DataSet& frame : own) {
    const FrameGroups groups{.own = frame, .shared = shared.empty() ? none : shared.front()};
    DicomSlice start = of_file;
    start.frame = static_cast<int>(slices.size()) + 1;
    start.facets = facets_of(groups, dimensions);
    auto slice = slice_of(std::move(start), groups);
    if (!slice) return tl::unexpected(slice.error());
    slices.push_back(*std::move(slice));
  }
  return slices;
}

}  // namespace orcart
