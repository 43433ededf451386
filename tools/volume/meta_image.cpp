// MetaImage (.mha, .mhd) as ITK writes and reads it: its world is LPS, a row of TransformMatrix is where one
// axis runs.
#include <algorithm>
#include <cmath>

#include "tools/volume/header_words.hpp"
#include "tools/volume/volume_formats.hpp"

namespace orcart {

namespace {

struct MetaHeader {
  HeaderFields fields;
  std::vector<std::string> listed_files;
  std::size_t body_at = 0;
};

MetaHeader read_header(std::string_view text) {
  MetaHeader header;
  TextCursor cursor(text);
  while (!cursor.at_end()) {
    const std::string_view line = cursor.line();
    const auto equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string key = lower_case(std::string(trimmed(line.substr(0, equals))));
    header.fields[key] = trimmed(line.substr(equals + 1));
    if (key != "elementdatafile") continue;
    if (header.fields[key].starts_with("LIST"))
      while (!cursor.at_end())
        if (const auto name = trimmed(cursor.line()); !name.empty()) header.listed_files.emplace_back(name);
    break;
  }
  header.body_at = cursor.place();
  return header;
}

bool yes(const MetaHeader& header, std::initializer_list<const char*> keys) {
  const std::string word = lower_case(field(header.fields, keys).value_or("false"));
  return word == "true" || word == "1" || word == "yes";
}

bool is_text(const MetaHeader& header) {
  return lower_case(field(header.fields, {"binarydata"}).value_or("true")) == "false";
}

std::optional<VoxelType> voxel_type(const std::string& word) {
  const std::map<std::string, VoxelType> known{
      {"MET_UCHAR", VoxelType::u8},      {"MET_CHAR", VoxelType::i8},   {"MET_USHORT", VoxelType::u16},
      {"MET_SHORT", VoxelType::i16},     {"MET_UINT", VoxelType::u32},  {"MET_INT", VoxelType::i32},
      {"MET_ULONG", VoxelType::u32},     {"MET_LONG", VoxelType::i32},  {"MET_ULONG_LONG", VoxelType::u64},
      {"MET_LONG_LONG", VoxelType::i64}, {"MET_FLOAT", VoxelType::f32}, {"MET_DOUBLE", VoxelType::f64}};
  const auto found = known.find(word);
  return found == known.end() ? std::nullopt : std::optional{found->second};
}

/// How many axes the file has: 3, or more of which the further ones are one voxel long.
std::size_t axes_of(const MetaHeader& header) {
  const auto sizes = numbers_of(field(header.fields, {"dimsize"}).value_or(""));
  return sizes ? std::max<std::size_t>(sizes->size(), 3) : 3;
}

/// One number for each axis, of which the first three count.
Result<std::vector<double>> for_each_axis(const std::string& name, const MetaHeader& header,
                                          std::initializer_list<const char*> keys, double fallback) {
  const auto text = field(header.fields, keys);
  if (!text) return std::vector<double>(3, fallback);
  auto numbers = numbers_of(*text, axes_of(header));
  if (!numbers)
    return fail(name + ": has " + *keys.begin() + " = " + *text + "; " + std::to_string(axes_of(header)) +
                " numbers are expected");
  return *std::move(numbers);
}

Result<void> place(const VolumeSource& source, const MetaHeader& header, VoxelLattice& lattice) {
  const std::string name = source.file.string();
  const auto matrix = field(header.fields, {"transformmatrix", "rotation", "orientation"});
  if (!matrix && !source.where_unstated) return unstated_space(name, "no TransformMatrix");
  const std::size_t axes = axes_of(header), numbers = axes * axes;
  const auto whole = matrix ? numbers_of(*matrix, numbers) : std::nullopt;
  if (matrix && !whole)
    return fail(name + ": has TransformMatrix = " + *matrix + "; " + std::to_string(numbers) +
                " numbers are expected");
  const auto spacing = for_each_axis(name, header, {"elementspacing", "elementsize"}, 1);
  const auto offset = for_each_axis(name, header, {"offset", "position", "origin"}, 0);
  if (!spacing) return tl::unexpected(spacing.error());
  if (!offset) return tl::unexpected(offset.error());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lattice.origin_mm[axis] = (*offset)[axis];
    for (std::size_t row = 0; row < 3; ++row)
      lattice.step_mm[axis][row] = (whole         ? (*whole)[axes * axis + row]
                                    : axis == row ? 1
                                                  : 0) *
                                   std::abs((*spacing)[axis]);
  }
  if (!matrix) convert_to_lps(*source.where_unstated, lattice);
  return {};
}

Result<void> take_sizes(const std::string& name, MetaHeader& header, VoxelLattice& lattice) {
  const auto sizes = numbers_of(header.fields["dimsize"]);
  if (!sizes) return fail(name + ": has DimSize = " + header.fields["dimsize"] + "; numbers are expected");
  std::size_t dimensions = sizes->size();
  while (dimensions > 3 && (*sizes)[dimensions - 1] == 1) --dimensions;
  if (dimensions != 3)
    return fail(name + ": has " + std::to_string(sizes->size()) + " dimensions; 3 are accepted");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!((*sizes)[axis] >= 1 && (*sizes)[axis] <= 100'000))
      return fail(name + ": has DimSize = " + header.fields["dimsize"] + "; 1 to 100000 are accepted");
    lattice.size[axis] = static_cast<int>((*sizes)[axis]);
  }
  const std::string channels = field(header.fields, {"elementnumberofchannels"}).value_or("1");
  if (channels != "1")
    return fail(name + ": has " + channels + " numbers a voxel; one intensity is accepted");
  return {};
}

Result<std::vector<std::byte>> detached_body(const VolumeSource& source, const MetaHeader& header,
                                             const Volume& volume, VoxelType type) {
  const std::string name = source.file.string(), stated = header.fields.at("elementdatafile");
  auto names = detached_names(name, stated, header.listed_files, volume.lattice.size[2]);
  if (!names) return tl::unexpected(names.error());
  const std::size_t files = names->size();
  DetachedFiles detached{.folder = source.file.parent_path(), .names = *std::move(names)};
  const auto skip = numbers_of(field(header.fields, {"headersize"}).value_or("0"), 1);
  detached.skip_bytes = skip ? static_cast<std::int64_t>((*skip)[0]) : 0;
  const bool counted = !yes(header, {"compresseddata"}) && !is_text(header);
  detached.bytes_each = counted ? volume.lattice.voxels() * bytes_of(type) / files : 0;
  return read_detached(name, detached);
}

}  // namespace

bool is_meta_image(std::span<const std::byte> bytes) {
  const auto holds = [&](std::size_t within, const char* word) {
    return text_of(bytes.first(std::min(bytes.size(), within))).find(word) != std::string_view::npos;
  };
  constexpr std::size_t kStart = 4096,
                        kLongestHeader = std::size_t{1} << 20U;  // PLUS puts hundreds of fields first
  return holds(kStart, "NDims") && holds(kLongestHeader, "DimSize") &&
         holds(kLongestHeader, "ElementDataFile");
}

Result<Volume> parse_meta_image(const VolumeSource& source) {
  const std::string name = source.file.string();
  MetaHeader header = read_header(text_of(source.bytes));
  Volume volume;
  if (auto taken = take_sizes(name, header, volume.lattice); !taken) return tl::unexpected(taken.error());
  const std::string word = header.fields["elementtype"];
  const auto type = voxel_type(word);
  if (!type)
    return fail(name + ": has ElementType = " + word + "; one integer or real number a voxel is accepted");
  if (auto placed = place(source, header, volume.lattice); !placed) return tl::unexpected(placed.error());
  if (auto sound = check_lattice(name, volume.lattice); !sound) return tl::unexpected(sound.error());
  volume.kind = std::string("MetaImage, ") + name_of(*type);

  std::vector<std::byte> own;
  std::span<const std::byte> body = source.bytes.subspan(header.body_at);
  if (lower_case(header.fields["elementdatafile"]) != "local") {
    auto read = detached_body(source, header, volume, *type);
    if (!read) return tl::unexpected(read.error());
    own = *std::move(read);
    body = own;
  }
  if (is_text(header)) {
    if (auto taken = take_text_voxels(name, body, volume); !taken) return tl::unexpected(taken.error());
    return volume;
  }
  const std::size_t wanted = volume.lattice.voxels() * bytes_of(*type);
  if (yes(header, {"compresseddata"})) {  // a detached gzip is unpacked already; noise is no shorter packed
    auto plain = inflate(body, wanted);
    if (plain.size() == wanted || body.size() < wanted) {
      own = std::move(plain);
      body = own;
    }
  }
  const VoxelEncoding encoding{.type = *type,
                               .big_endian = yes(header, {"binarydatabyteordermsb", "elementbyteordermsb"})};
  if (auto taken = take_voxels(name, body, encoding, volume); !taken) return tl::unexpected(taken.error());
  return volume;
}

}  // namespace orcart
