// The volume formats, each from its bytes to a volume: NIfTI, NRRD, MetaImage and MGH.
#pragma once

#include <optional>
#include <span>

#include "firmware-host/files/space.hpp"
#include "tools/volume/volume.hpp"
#include "tools/volume/voxel_numbers.hpp"

namespace orcart {

/// What a parser needs to know beside the bytes.
struct VolumeSource {
  std::filesystem::path file;  ///< for messages, and the folder that detached voxels lie in
  std::span<const std::byte> bytes;
  std::optional<Space> where_unstated;  ///< the space of a file that states none
};

bool is_nifti(std::span<const std::byte> bytes);
bool is_nrrd(std::span<const std::byte> bytes);
bool is_meta_image(std::span<const std::byte> bytes);
bool is_mgh(std::span<const std::byte> bytes);

Result<Volume> parse_nifti(const VolumeSource& source);
Result<Volume> parse_nrrd(const VolumeSource& source);
Result<Volume> parse_meta_image(const VolumeSource& source);
Result<Volume> parse_mgh(const VolumeSource& source);

/// RAS and LPS differ by half a turn about the vertical.
void convert_to_lps(Space space, VoxelLattice& lattice);

/// Refuses a size below 2 in an axis (no volume), over kMostVoxels, and steps that are not independent.
Result<void> check_lattice(const std::string& name, const VoxelLattice& lattice);

/// Sentence for a file that says nothing about where the patient lies.
tl::unexpected<Error> unstated_space(const std::string& name, const std::string& missing);

/// Takes exactly the lattice's voxels from `bytes`; refuses fewer.
Result<void> take_voxels(const std::string& name, std::span<const std::byte> bytes,
                         const VoxelEncoding& encoding, Volume& volume);

/// The same from numbers written as text.
Result<void> take_text_voxels(const std::string& name, std::span<const std::byte> bytes, Volume& volume);

std::string_view text_of(std::span<const std::byte> bytes);

/// Detached voxels: whole files one after the other, as a header names them (relative to its folder).
struct DetachedFiles {
  std::filesystem::path folder;
  std::vector<std::string> names;
  std::int64_t skip_lines = 0;   ///< of each file, before its bytes are counted
  std::int64_t skip_bytes = 0;   ///< of each file; -1: the voxels are its end
  std::uint64_t bytes_each = 0;  ///< 0 where it is not known: text, or one packed file
};
/// `stated` is a name, or a pattern with first, last and step; `listed` wins where it is not empty. Refuses
/// another number of files than one or one a slice.
Result<std::vector<std::string>> detached_names(const std::string& name, const std::string& stated,
                                                const std::vector<std::string>& listed, int slices);
Result<std::vector<std::byte>> read_detached(const std::string& name, const DetachedFiles& detached);

}  // namespace orcart
