// What the volume formats share: spaces, sizes, voxels beside their header.
#include "tools/volume/volume_formats.hpp"

#include <algorithm>
#include <cmath>

#include "tools/volume/header_words.hpp"
namespace orcart {

namespace {

/// NAME%dEND with its first, last and step, as NRRD and MetaImage write a series of slices.
std::vector<std::string> names_of_pattern(const std::string& pattern, int first, int last, int step) {
  constexpr std::size_t kMostFiles = 100'000;
  std::vector<std::string> names;
  const std::size_t percent = pattern.find('%'), letter = pattern.find('d', percent);
  if (percent == std::string::npos || letter == std::string::npos || step == 0) return names;
  int width = 0;
  char padding = ' ';
  for (std::size_t i = percent + 1; i < letter; ++i) {
    if (pattern[i] == '0' && width == 0) padding = '0';
    if (pattern[i] < '0' || pattern[i] > '9') return names;
    width = std::min(width * 10 + pattern[i] - '0', 12);
  }
  for (int i = first; (step > 0 ? i <= last : i >= last) && names.size() < kMostFiles; i += step) {
    std::string number = std::to_string(i);
    number.insert(0, static_cast<std::size_t>(std::max(0, width - static_cast<int>(number.size()))), padding);
    names.push_back(pattern.substr(0, percent) + number + pattern.substr(letter + 1));
  }
  return names;
}

}  // namespace

void convert_to_lps(Space space, VoxelLattice& lattice) {
  if (space == Space::lps) return;
  for (std::size_t row = 0; row < 2; ++row) {
    lattice.origin_mm[row] = -lattice.origin_mm[row];
    for (auto& step : lattice.step_mm) step[row] = -step[row];
  }
}

Result<void> check_lattice(const std::string& name, const VoxelLattice& lattice) {
  const auto& [nx, ny, nz] = lattice.size;
  const std::string size = std::to_string(nx) + "x" + std::to_string(ny) + "x" + std::to_string(nz);
  if (std::min({nx, ny, nz}) < 2)
    return fail(name + ": is " + size + " voxels; a volume of at least 2 in each direction is expected");
  if (lattice.voxels() > kMostVoxels)
    return fail(name + ": has " + std::to_string(lattice.voxels()) + " voxels; up to " +
                std::to_string(kMostVoxels) + " are accepted");
  const double lengths = step_length_mm(lattice, 0) * step_length_mm(lattice, 1) * step_length_mm(lattice, 2);
  const double volume = std::abs(voxel_mm3(lattice));
  if (!(lengths > 1e-12 && lengths < 1e9 && volume > 0.05 * lengths))
    return fail(name + ": its voxels measure " + std::to_string(step_length_mm(lattice, 0)) + " x " +
                std::to_string(step_length_mm(lattice, 1)) + " x " +
                std::to_string(step_length_mm(lattice, 2)) +
                " mm along axes that do not span a space; positive sizes and independent axes are expected");
  return {};
}

tl::unexpected<Error> unstated_space(const std::string& name, const std::string& missing) {
  return fail(name + ": states no patient coordinates (" + missing +
              "); --space LPS or --space RAS, saying where its axes run, is expected");
}

Result<void> take_voxels(const std::string& name, std::span<const std::byte> bytes,
                         const VoxelEncoding& encoding, Volume& volume) {
  const std::uint64_t wanted = volume.lattice.voxels() * bytes_of(encoding.type);
  if (bytes.size() < wanted)
    return fail(name + ": holds fewer than the " + std::to_string(wanted) +
                " bytes its header says; it is cut short");
  volume.values.reserve(volume.lattice.voxels());
  append_numbers(bytes.first(wanted), encoding, volume.values);
  return {};
}

Result<std::vector<std::byte>> read_detached(const std::string& name, const DetachedFiles& detached) {
  std::vector<std::byte> all;
  for (const std::string& file : detached.names) {
    auto bytes = read_plain(detached.folder / file);
    if (!bytes) return fail(name + ": its voxels are missing: " + bytes.error().message);
    for (std::int64_t line = 0; line < detached.skip_lines; ++line) {
      const auto end = std::find(bytes->begin(), bytes->end(), std::byte{'\n'});
      if (end == bytes->end()) break;
      bytes->erase(bytes->begin(), end + 1);
    }
    const std::uint64_t least = detached.bytes_each + std::max<std::int64_t>(detached.skip_bytes, 0);
    if (bytes->size() < least)
      return fail((detached.folder / file).string() + ": holds fewer than the " + std::to_string(least) +
                  " bytes " + name + " says; it is cut short");
    const std::size_t skip = detached.skip_bytes < 0 ? bytes->size() - detached.bytes_each
                                                     : static_cast<std::size_t>(detached.skip_bytes);
    const auto first = bytes->begin() + static_cast<std::ptrdiff_t>(skip);
    if (detached.names.size() == 1) {
      bytes->erase(bytes->begin(), first);
      return bytes;
    }
    all.insert(all.end(), first, first + static_cast<std::ptrdiff_t>(detached.bytes_each));
  }
  return all;
}

Result<std::vector<std::string>> detached_names(const std::string& name, const std::string& stated,
                                                const std::vector<std::string>& listed, int slices) {
  std::vector<std::string> names = listed;
  const auto words = words_of(stated);
  if (names.empty() && words.size() >= 4 && stated.find('%') != std::string::npos) {
    const auto range = numbers_of(words[1] + " " + words[2] + " " + words[3], 3);
    if (range)
      names = names_of_pattern(words[0], static_cast<int>((*range)[0]), static_cast<int>((*range)[1]),
                               static_cast<int>((*range)[2]));
  } else if (names.empty()) {
    names = {stated};
  }
  if (names.empty() || (names.size() != 1 && names.size() != static_cast<std::size_t>(slices)))
    return fail(name + ": names " + std::to_string(names.size()) + " data files for " +
                std::to_string(slices) + " slices; one for each, or one for all, is expected");
  return names;
}

std::string_view text_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<void> take_text_voxels(const std::string& name, std::span<const std::byte> bytes, Volume& volume) {
  TextCursor words(text_of(bytes));
  volume.values.reserve(volume.lattice.voxels());
  for (std::size_t i = 0; i < volume.lattice.voxels(); ++i) {
    const auto number = words.number<double>();
    if (!number) return fail(name + ": voxel " + std::to_string(i) + " is no number; it is cut short");
    volume.values.push_back(static_cast<float>(*number));
  }
  return {};
}

}  // namespace orcart
