// NRRD, attached and detached (Kindlmann, "Definition of NRRD File Format", teem.sourceforge.net).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "tools/volume/header_words.hpp"
#include "tools/volume/volume_formats.hpp"

namespace orcart {

namespace {

struct NrrdHeader {
  HeaderFields fields;
  std::vector<std::string> listed_files;  ///< after `data file: LIST`
  std::size_t body_at = 0;
};

NrrdHeader read_header(std::string_view text) {
  NrrdHeader header;
  TextCursor cursor(text);
  cursor.line();
  while (!cursor.at_end()) {
    const std::string_view line = cursor.line();
    if (line.empty()) break;
    const auto colon = line.find(": ");
    if (line[0] == '#' || colon == std::string_view::npos) continue;
    std::string key = lower_case(std::string(line.substr(0, colon)));
    std::erase(key, ' ');  // `data file` and `datafile`
    header.fields[key] = trimmed(line.substr(colon + 2));
    if (key != "datafile" || !header.fields[key].starts_with("LIST")) continue;
    while (!cursor.at_end())
      if (const auto name = trimmed(cursor.line()); !name.empty()) header.listed_files.emplace_back(name);
  }
  header.body_at = cursor.place();
  return header;
}

std::optional<VoxelType> voxel_type(const std::string& word) {
  const std::map<std::string, VoxelType> known{{"signed char", VoxelType::i8},
                                               {"int8", VoxelType::i8},
                                               {"int8_t", VoxelType::i8},
                                               {"uchar", VoxelType::u8},
                                               {"unsigned char", VoxelType::u8},
                                               {"uint8", VoxelType::u8},
                                               {"uint8_t", VoxelType::u8},
                                               {"short", VoxelType::i16},
                                               {"short int", VoxelType::i16},
                                               {"signed short", VoxelType::i16},
                                               {"int16", VoxelType::i16},
                                               {"int16_t", VoxelType::i16},
                                               {"ushort", VoxelType::u16},
                                               {"unsigned short", VoxelType::u16},
                                               {"unsigned short int", VoxelType::u16},
                                               {"uint16", VoxelType::u16},
                                               {"uint16_t", VoxelType::u16},
                                               {"int", VoxelType::i32},
                                               {"signed int", VoxelType::i32},
                                               {"int32", VoxelType::i32},
                                               {"int32_t", VoxelType::i32},
                                               {"uint", VoxelType::u32},
                                               {"unsigned int", VoxelType::u32},
                                               {"uint32", VoxelType::u32},
                                               {"uint32_t", VoxelType::u32},
                                               {"longlong", VoxelType::i64},
                                               {"long long", VoxelType::i64},
                                               {"int64", VoxelType::i64},
                                               {"int64_t", VoxelType::i64},
                                               {"ulonglong", VoxelType::u64},
                                               {"unsigned long long", VoxelType::u64},
                                               {"uint64", VoxelType::u64},
                                               {"uint64_t", VoxelType::u64},
                                               {"float", VoxelType::f32},
                                               {"double", VoxelType::f64}};
  const auto found = known.find(lower_case(word));
  return found == known.end() ? std::nullopt : std::optional{found->second};
}

/// Signs that take the file's axes to LPS; nothing where the space is no patient space.
std::optional<std::array<double, 3>> signs_of(std::string space) {
  space = lower_case(std::move(space));
  if (space.ends_with("-time")) return std::nullopt;
  if (space == "lps" || space == "left-posterior-superior") return std::array{1.0, 1.0, 1.0};
  if (space == "ras" || space == "right-anterior-superior") return std::array{-1.0, -1.0, 1.0};
  if (space == "las" || space == "left-anterior-superior") return std::array{1.0, -1.0, 1.0};
  return std::nullopt;
}

Result<void> take_directions(const std::string& name, const NrrdHeader& header, VoxelLattice& lattice) {
  const auto directions = field(header.fields, {"spacedirections"});
  const auto origin = field(header.fields, {"spaceorigin"});
  const auto nine = directions ? numbers_of(*directions, 9) : std::nullopt;
  const auto three = origin ? numbers_of(*origin, 3) : std::optional{std::vector<double>(3, 0.0)};
  if (!nine || !three)
    return fail(name + ": has space directions \"" + directions.value_or("") + "\" and space origin \"" +
                origin.value_or("") + "\"; three vectors of three numbers, and one, are expected");
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t row = 0; row < 3; ++row) lattice.step_mm[axis][row] = (*nine)[3 * axis + row];
  for (std::size_t row = 0; row < 3; ++row) lattice.origin_mm[row] = (*three)[row];
  return {};
}

/// Millimetres in the unit of the file's places, which stands once for each axis of the space; unstated, it
/// is one.
Result<double> unit_mm(const std::string& name, const NrrdHeader& header) {
  std::string units = lower_case(field(header.fields, {"spaceunits", "units"}).value_or(""));
  std::replace(units.begin(), units.end(), '"', ' ');
  std::optional<double> found;
  for (const std::string& word : words_of(units)) {
    const double mm = word == "m" || word.starts_with("met")      ? 1000
                      : word == "cm" || word.starts_with("centi") ? 10
                      : word == "um" || word.starts_with("micro") ? 0.001
                                                                  : 1;
    if (found.value_or(mm) != mm)
      return fail(name + ": has the units " + units + "; one unit for all three axes is expected");
    found = mm;
  }
  return found.value_or(1);
}

Result<void> place_in_its_unit(const VolumeSource& source, const NrrdHeader& header, VoxelLattice& lattice) {
  const std::string name = source.file.string();
  const std::string space = field(header.fields, {"space"}).value_or("");
  const auto signs = signs_of(space);
  if (signs && header.fields.contains("spacedirections")) {
    if (auto taken = take_directions(name, header, lattice); !taken) return taken;
    for (std::size_t row = 0; row < 3; ++row) {
      lattice.origin_mm[row] *= (*signs)[row];
      for (auto& step : lattice.step_mm) step[row] *= (*signs)[row];
    }
    return {};
  }
  if (!source.where_unstated)
    return unstated_space(name, space.empty() ? "no space" : "its space is \"" + space + "\"");
  if (header.fields.contains("spacedirections")) {
    if (auto taken = take_directions(name, header, lattice); !taken) return taken;
  } else {
    const auto spacings = numbers_of(field(header.fields, {"spacings"}).value_or(""), 3);
    if (!spacings)
      return fail(name + ": has spacings \"" + field(header.fields, {"spacings"}).value_or("") +
                  "\"; three numbers in millimetres are expected");
    for (std::size_t axis = 0; axis < 3; ++axis) lattice.step_mm[axis][axis] = std::abs((*spacings)[axis]);
  }
  convert_to_lps(*source.where_unstated, lattice);
  return {};
}

Result<void> place(const VolumeSource& source, const NrrdHeader& header, VoxelLattice& lattice) {
  const auto mm = unit_mm(source.file.string(), header);
  if (!mm) return tl::unexpected(mm.error());
  if (auto placed = place_in_its_unit(source, header, lattice); !placed) return placed;
  for (std::size_t row = 0; row < 3; ++row) {
    lattice.origin_mm[row] *= *mm;
    for (auto& step : lattice.step_mm) step[row] *= *mm;
  }
  return {};
}

/// Drops an axis that has one sample and no direction: a channel, or a time, that there is only one of.
void drop_single_axis(NrrdHeader& header) {
  std::vector<std::string> sizes = words_of(field(header.fields, {"sizes"}).value_or("")), directions;
  for (const std::string& word : words_of(field(header.fields, {"spacedirections"}).value_or("")))
    if (word.starts_with('(') || word == "none" || directions.empty())
      directions.push_back(word);
    else
      directions.back() += " " + word;  // a blank within the brackets
  if (sizes.size() != 4 || directions.size() != 4) return;
  const auto none = std::find(directions.begin(), directions.end(), "none") - directions.begin();
  if (none == 4 || sizes[static_cast<std::size_t>(none)] != "1") return;
  sizes.erase(sizes.begin() + none);
  directions.erase(directions.begin() + none);
  header.fields["dimension"] = "3";
  header.fields["sizes"] = sizes[0] + " " + sizes[1] + " " + sizes[2];
  header.fields["spacedirections"] = directions[0] + " " + directions[1] + " " + directions[2];
}

Result<void> take_sizes(const std::string& name, NrrdHeader& header, VoxelLattice& lattice) {
  const auto sizes = numbers_of(field(header.fields, {"sizes"}).value_or(""));
  const std::string dimension = field(header.fields, {"dimension"}).value_or("?");
  if (!sizes || std::to_string(sizes->size()) != dimension)
    return fail(name + ": says dimension " + dimension + " and sizes \"" +
                field(header.fields, {"sizes"}).value_or("") +
                "\"; as many sizes as dimensions are expected");
  if (sizes->size() != 3)
    return fail(name + ": has " + dimension +
                " dimensions (a series, a tensor or a colour?); one intensity a voxel in 3 dimensions is "
                "accepted");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!((*sizes)[axis] >= 1 && (*sizes)[axis] <= 100'000))
      return fail(name + ": has the sizes \"" + header.fields["sizes"] + "\"; 1 to 100000 are accepted");
    lattice.size[axis] = static_cast<int>((*sizes)[axis]);
  }
  return {};
}

/// Slices that a pattern or a list names each hold one layer, or the one file holds all.
Result<std::vector<std::byte>> detached_body(const VolumeSource& source, const NrrdHeader& header,
                                             const std::string& stated, const VoxelLattice& lattice,
                                             VoxelType type) {
  const std::string name = source.file.string();
  auto names = detached_names(name, stated, header.listed_files, lattice.size[2]);
  if (!names) return tl::unexpected(names.error());
  const std::size_t files = names->size();
  DetachedFiles detached{.folder = source.file.parent_path(), .names = *std::move(names)};
  const auto skip = numbers_of(field(header.fields, {"byteskip"}).value_or("0"), 1),
             lines = numbers_of(field(header.fields, {"lineskip"}).value_or("0"), 1);
  if (lines) detached.skip_lines = static_cast<std::int64_t>((*lines)[0]);
  detached.skip_bytes = skip ? static_cast<std::int64_t>((*skip)[0]) : 0;
  const std::string coding = lower_case(field(header.fields, {"encoding"}).value_or(""));
  const bool counted = coding == "raw" || coding == "gzip" || coding == "gz";
  detached.bytes_each = counted ? lattice.voxels() * bytes_of(type) / files : 0;
  return read_detached(name, detached);
}

}  // namespace

bool is_nrrd(std::span<const std::byte> bytes) {
  return text_of(bytes).starts_with("NRRD000");
}

Result<Volume> parse_nrrd(const VolumeSource& source) {
  const std::string name = source.file.string();
  NrrdHeader header = read_header(text_of(source.bytes));
  drop_single_axis(header);
  Volume volume;
  if (auto taken = take_sizes(name, header, volume.lattice); !taken) return tl::unexpected(taken.error());
  const auto type = voxel_type(header.fields["type"]);
  if (!type)
    return fail(name + ": has the type \"" + header.fields["type"] +
                "\"; an integer or a real number is accepted");
  if (auto placed = place(source, header, volume.lattice); !placed) return tl::unexpected(placed.error());
  if (auto sound = check_lattice(name, volume.lattice); !sound) return tl::unexpected(sound.error());
  const std::string coding = lower_case(header.fields["encoding"]);
  const bool text = coding == "ascii" || coding == "text" || coding == "txt", raw = coding == "raw";
  if (!text && !raw && coding != "gzip" && coding != "gz")
    return fail(name + ": has the encoding \"" + coding + "\"; raw, gzip and text are accepted");
  volume.kind = std::string("NRRD, ") + name_of(*type);

  std::vector<std::byte> own;
  std::span<const std::byte> body = source.bytes.subspan(header.body_at);
  if (const auto stated = field(header.fields, {"datafile"})) {
    auto read = detached_body(source, header, *stated, volume.lattice, *type);
    if (!read) return tl::unexpected(read.error());
    own = *std::move(read);
    body = own;
  }
  if (text) {
    if (auto taken = take_text_voxels(name, body, volume); !taken) return tl::unexpected(taken.error());
    return volume;
  }
  if (!raw && !header.fields.contains("datafile")) {
    own = inflate(body, volume.lattice.voxels() * bytes_of(*type));
    body = own;
  }
  const VoxelEncoding encoding{.type = *type, .big_endian = lower_case(header.fields["endian"]) == "big"};
  if (auto taken = take_voxels(name, body, encoding, volume); !taken) return tl::unexpected(taken.error());
  return volume;
}

}  // namespace orcart
