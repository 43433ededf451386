// NIfTI, NRRD and MetaImage: numbers, places, and what is wrong with a file.
#include <zlib.h>

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {
namespace {

/// A NIfTI-1 header of 3 x 2 x 2 voxels of int16, with what the test puts into it.
struct Nifti {
  std::string bytes = std::string(352, '\0');

  Nifti() {
    put<std::int32_t>(0, 348);
    const std::int16_t dim[] = {3, 3, 2, 2, 1, 1, 1, 1};
    for (std::size_t i = 0; i < 8; ++i) put<std::int16_t>(40 + 2 * i, dim[i]);
    put<std::int16_t>(70, 4);
    for (std::size_t i = 0; i < 4; ++i) put<float>(76 + 4 * i, i == 3 ? 2.0F : 1.0F);
    put<float>(108, 352);
    bytes.replace(344, 4, std::string("n+1\0", 4));
    for (std::int16_t i = 0; i < 12; ++i) bytes.append(reinterpret_cast<const char*>(&i), 2);
  }
  template <class Number>
  void put(std::size_t at, Number value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
  }
  Nifti& sform() {
    const float rows[] = {0, -2, 0, 10, 3, 0, 0, 20, 0, 0, 4, 30};
    put<std::int16_t>(254, 1);
    for (std::size_t i = 0; i < 12; ++i) put<float>(280 + 4 * i, rows[i]);
    return *this;
  }
};

Result<Volume> read(const TemporaryFolder& folder, const std::string& name, const std::string& bytes,
                    std::optional<Space> space = std::nullopt) {
  return read_volume({.path = folder.write(name, bytes), .where_unstated = space});
}

void expect_refused(const Result<Volume>& volume, const std::string& why) {
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().message.find(why), std::string::npos) << volume.error().message;
}

std::string gzipped(const TemporaryFolder& folder, const std::string& bytes) {
  const auto file = folder / "zip";
  const gzFile out = gzopen(file.c_str(), "wb");
  gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(out);
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(NiftiFile, ItsFullAffineIsTurnedFromRasToLps) {
  const TemporaryFolder folder;
  const auto volume = read(folder, "v.nii", Nifti().sform().bytes);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{-10, -20, 30}));
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{0, -3, 0}));
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{2, 0, 0}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, 0, 4}));
  EXPECT_EQ(volume->values[5], 5);
  EXPECT_EQ(volume->series, "v.nii");
}

TEST(NiftiFile, AQuaternionIsObeyedWithItsHandedness) {
  const TemporaryFolder folder;
  Nifti file;
  file.put<std::int16_t>(252, 1);
  file.put<float>(76, -1);   // qfac: the third axis turned
  file.put<float>(264, 1);   // half a turn about z: (0, 0, 1)
  file.put<float>(268, 90);  // x
  const auto volume = read(folder, "v.nii", file.bytes);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_NEAR(volume->lattice.step_mm[0][0], 1, 1e-6);  // -x in RAS is +x in LPS
  EXPECT_NEAR(volume->lattice.step_mm[1][1], 1, 1e-6);
  EXPECT_NEAR(volume->lattice.step_mm[2][2], -2, 1e-6);
  EXPECT_NEAR(volume->lattice.origin_mm[0], -90, 1e-6);
}

TEST(NiftiFile, OfTwoFormsThatDisagreeTheScannersIsTakenAndTold) {
  const TemporaryFolder folder;
  Nifti file = Nifti().sform();  // voxels of 3 x 2 x 4 mm out of 1 x 1 x 2
  file.put<std::int16_t>(252, 1);
  file.put<std::int16_t>(254, 4);  // MNI
  const auto volume = read(folder, "v.nii", file.bytes);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_NEAR(step_length_mm(volume->lattice, 0), 1, 1e-6);
  EXPECT_NEAR(step_length_mm(volume->lattice, 2), 2, 1e-6);
  ASSERT_EQ(volume->notes.size(), 1U);
  EXPECT_NE(volume->notes[0].find("its qform (code 1) and its sform (code 4) lie up to"), std::string::npos);
  EXPECT_NE(volume->notes[0].find("the qform, in the scanner's coordinates, was taken"), std::string::npos)
      << volume->notes[0];
  file.put<std::int16_t>(252, 2);
  file.put<std::int16_t>(254, 1);
  const auto by_sform = read(folder, "v.nii", file.bytes);
  ASSERT_TRUE(by_sform);
  EXPECT_NEAR(step_length_mm(by_sform->lattice, 0), 3, 1e-6);
  EXPECT_NE(by_sform->notes.at(0).find("the sform, in the scanner's"), std::string::npos);
}

TEST(NiftiFile, AnAffineThatStretchesIsTold) {
  const TemporaryFolder folder;
  const auto volume = read(folder, "v.nii", Nifti().sform().bytes);
  ASSERT_TRUE(volume);
  ASSERT_EQ(volume->notes.size(), 1U);
  EXPECT_NE(volume->notes[0].find("3.000 x 2.000 x 4.000 mm out of those of 1.000 x 1.000 x 2.000 mm"),
            std::string::npos)
      << volume->notes[0];
}

TEST(NiftiFile, FormsThatAgreeAreOneAndNothingIsTold) {
  const TemporaryFolder folder;
  Nifti file;
  const float rows[] = {1, 0, 0, 10, 0, 1, 0, 20, 0, 0, 2.01F, 30};
  for (std::size_t i = 0; i < 12; ++i) file.put<float>(280 + 4 * i, rows[i]);
  for (std::size_t i = 0; i < 3; ++i) file.put<float>(268 + 4 * i, rows[4 * i + 3]);
  file.put<std::int16_t>(252, 1);
  file.put<std::int16_t>(254, 4);
  const auto volume = read(folder, "v.nii", file.bytes);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_NEAR(step_length_mm(volume->lattice, 2), 2.01, 1e-6);
  EXPECT_TRUE(volume->notes.empty()) << volume->notes[0];
}

TEST(NiftiFile, VoxelsNeverStartWithinTheHeader) {
  const TemporaryFolder folder;
  for (const float offset : {0.0F, -4.0F, 348.0F, 352.0F}) {
    Nifti file = Nifti().sform();
    file.put<float>(108, offset);
    const auto volume = read(folder, "v.nii", file.bytes);
    ASSERT_TRUE(volume) << volume.error().message;
    EXPECT_EQ(volume->values[5], 5) << offset;
  }
  for (const float offset : {NAN, INFINITY, 1e30F}) {
    Nifti file = Nifti().sform();
    file.put<float>(108, offset);
    expect_refused(read(folder, "v.nii", file.bytes), "a place within the file is expected");
  }
  Nifti beyond = Nifti().sform();
  beyond.put<float>(108, 1e9F);
  expect_refused(read(folder, "v.nii", beyond.bytes), "cut short");
}

TEST(NiftiFile, SlopeGzipAndByteOrder) {
  const TemporaryFolder folder;
  Nifti scaled = Nifti().sform();
  scaled.put<float>(112, 0.5F);
  scaled.put<float>(116, 7);
  const auto volume = read(folder, "v.nii.gz", gzipped(folder, scaled.bytes));
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->values[4], 9);
}

TEST(NiftiFile, WithoutAnOrientationIsRefusedUntilTold) {
  const TemporaryFolder folder;
  expect_refused(read(folder, "v.nii", Nifti().bytes), "--space LPS or --space RAS");
  const auto told = read(folder, "v.nii", Nifti().bytes, Space::ras);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->lattice.step_mm[0][0], -1);
  EXPECT_EQ(told->lattice.step_mm[2][2], 2);
}

TEST(NiftiFile, AFourthDimensionColourAndAShortFileAreRefused) {
  const TemporaryFolder folder;
  Nifti series = Nifti().sform();
  series.put<std::int16_t>(40, 4);
  series.put<std::int16_t>(48, 64);
  expect_refused(read(folder, "v.nii", series.bytes), "64 volumes in one file");
  Nifti colour = Nifti().sform();
  colour.put<std::int16_t>(70, 128);
  expect_refused(read(folder, "v.nii", colour.bytes), "NIfTI type 128");
  std::string cut = Nifti().sform().bytes;
  cut.pop_back();
  expect_refused(read(folder, "v.nii", cut), "fewer than the 24 bytes its header says; it is cut short");
}

TEST(NiftiFile, NeverReadsBeyondACutHeader) {
  const TemporaryFolder folder;
  const std::string whole = Nifti().sform().bytes;
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(read(folder, "v.nii", whole.substr(0, length)));
}

constexpr const char* kNrrd =
    "NRRD0004\n# made by hand\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 3 2 2\n"
    "space directions: (1,0,0) (0,0,2) (0,-3,0)\nkinds: domain domain domain\nendian: big\nencoding: raw\n"
    "space origin: (5,6,7)\n\n";

std::string big_shorts() {
  std::string bytes;
  for (int i = 0; i < 12; ++i) bytes += {'\0', static_cast<char>(i)};
  return bytes;
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST(NrrdFile, ObeysDirectionsOriginAndByteOrder) {
  const TemporaryFolder folder;
  const auto volume = read(folder, "v.nrrd", kNrrd + big_shorts());
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{0, 0, 2}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, -3, 0}));
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{5, 6, 7}));
  EXPECT_EQ(volume->values[11], 11);
}

TEST(NrrdFile, RasIsTurnedAndGzipUnpacked) {
  const TemporaryFolder folder;
  const std::string ras = replaced(kNrrd, "left-posterior-superior", "right-anterior-superior");
  const auto volume = read(folder, "v.nrrd", replaced(ras, "raw", "gzip") + gzipped(folder, big_shorts()));
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{-5, -6, 7}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, 3, 0}));
  EXPECT_EQ(volume->values[7], 7);
}

TEST(NrrdFile, ADetachedHeaderNamesItsSlices) {
  const TemporaryFolder folder;
  folder.write("s.1", big_shorts().substr(0, 12));
  folder.write("s.2", big_shorts().substr(12));
  const auto volume =
      read(folder, "v.nhdr", replaced(kNrrd, "encoding: raw\n", "encoding: raw\ndata file: s.%d 1 2 1\n"));
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->values[11], 11);
  folder.write("s.2", "short");
  expect_refused(
      read(folder, "v.nhdr", replaced(kNrrd, "encoding: raw\n", "encoding: raw\ndata file: s.%d 1 2 1\n")),
      "s.2: holds fewer than the 12 bytes");
}

TEST(NrrdFile, ItsUnitIsObeyed) {
  const TemporaryFolder folder;
  const auto centimetres =
      read(folder, "v.nrrd",
           replaced(kNrrd, "sizes:", "space units: \"cm\" \"cm\" \"cm\"\nsizes:") + big_shorts());
  ASSERT_TRUE(centimetres) << centimetres.error().message;
  EXPECT_EQ(centimetres->lattice.step_mm[1], (PlainPoint{0, 0, 20}));
  EXPECT_EQ(centimetres->lattice.origin_mm, (PlainPoint{50, 60, 70}));
  expect_refused(read(folder, "v.nrrd",
                      replaced(kNrrd, "sizes:", "space units: \"m\" \"mm\" \"mm\"\nsizes:") + big_shorts()),
                 "one unit for all three axes");
}

TEST(NrrdFile, AnAxisOfOneChannelIsDropped) {
  const TemporaryFolder folder;
  const std::string header =
      replaced(replaced(replaced(replaced(kNrrd, "dimension: 3", "dimension: 4"), "sizes: 3", "sizes: 1 3"),
                        "kinds:", "kinds: vector"),
               "directions: (1,0,0)", "directions: none (1, 0,0)");
  const auto volume = read(folder, "v.nrrd", header + big_shorts());
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.size, (std::array{3, 2, 2}));
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{1, 0, 0}));
}

TEST(NrrdFile, LinesBytesAndTextInADetachedFile) {
  const TemporaryFolder folder;
  folder.write("v.raw", "a line\nanother\nxy" + big_shorts());
  const auto skipped = read(
      folder, "v.nhdr",
      replaced(kNrrd, "encoding: raw\n", "encoding: raw\nline skip: 2\nbyte skip: 2\ndata file: v.raw\n"));
  ASSERT_TRUE(skipped) << skipped.error().message;
  EXPECT_EQ(skipped->values[11], 11);
  folder.write("v.txt", "0 1 2 3 4 5 6 7 8 9 10 11");
  const auto text = read(
      folder, "t.nhdr",
      replaced(replaced(kNrrd, "short", "double"), "encoding: raw\n", "encoding: ascii\ndata file: v.txt\n"));
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(text->values[11], 11);
}

TEST(NrrdFile, WithoutAPatientSpaceIsRefusedUntilTold) {
  const TemporaryFolder folder;
  const std::string unstated =
      replaced(kNrrd, "space: left-posterior-superior", "space: 3D-left-handed") + big_shorts();
  expect_refused(read(folder, "v.nrrd", unstated), "its space is \"3D-left-handed\"");
  EXPECT_TRUE(read(folder, "v.nrrd", unstated, Space::lps));
}

TEST(NrrdFile, VectorsShortFilesAndUnknownEncodingsAreRefused) {
  const TemporaryFolder folder;
  expect_refused(read(folder, "v.nrrd", kNrrd + std::string("012345")), "cut short");
  expect_refused(read(folder, "v.nrrd", replaced(kNrrd, "raw", "bzip2") + big_shorts()),
                 "raw, gzip and text are accepted");
  expect_refused(read(folder, "v.nrrd",
                      replaced(replaced(kNrrd, "dimension: 3", "dimension: 4"), "sizes: 3", "sizes: 3 3")),
                 "one intensity a voxel in 3 dimensions");
}

constexpr const char* kMeta =
    "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\nCompressedData = "
    "False\n"
    "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 5 6 7\nElementSpacing = 1 2 3\nDimSize = 3 2 2\n"
    "ElementType = MET_SHORT\nElementDataFile = LOCAL\n";

TEST(MetaImageFile, ObeysMatrixOffsetAndByteOrder) {
  const TemporaryFolder folder;
  const auto volume = read(folder, "v.mha", kMeta + big_shorts());
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{0, 1, 0}));
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{-2, 0, 0}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, 0, 3}));
  EXPECT_EQ(volume->values[3], 3);
}

TEST(MetaImageFile, AFourthAxisOfOneVolumeIsDropped) {
  const TemporaryFolder folder;
  std::string header =
      replaced(replaced(kMeta, "NDims = 3", "NDims = 4"), "DimSize = 3 2 2", "DimSize = 3 2 2 1");
  header = replaced(replaced(header, "0 1 0 -1 0 0 0 0 1", "0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1"), "5 6 7",
                    "5 6 7 0");
  const auto volume =
      read(folder, "v.mha", replaced(header, "Spacing = 1 2 3", "Spacing = 1 2 3 1") + big_shorts());
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{5, 6, 7}));
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{0, 1, 0}));
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{-2, 0, 0}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, 0, 3}));
  expect_refused(read(folder, "v.mha", header + big_shorts()), "spacing = 1 2 3; 4 numbers are expected");
}

TEST(MetaImageFile, DetachedAndCompressedVoxels) {
  const TemporaryFolder folder;
  folder.write("v.zraw", gzipped(folder, big_shorts()));
  const std::string header =
      replaced(replaced(kMeta, "CompressedData = False", "CompressedData = True"), "LOCAL", "v.zraw");
  const auto volume = read(folder, "v.mhd", header);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->values[11], 11);
  expect_refused(read(folder, "v.mhd", replaced(header, "v.zraw", "gone.raw")), "its voxels are missing");
}

TEST(MetaImageFile, NoiseIsNoShorterPackedAndIsUnpackedAllTheSame) {
  const TemporaryFolder folder;
  std::string packed(64, '\0');
  uLongf size = packed.size();
  ASSERT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(big_shorts().data()), 24),
            Z_OK);
  packed.resize(std::max<std::size_t>(size, 24), 'x');
  const auto volume =
      read(folder, "v.mha", replaced(kMeta, "CompressedData = False", "CompressedData = True") + packed);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->values[11], 11);
}

TEST(MetaImageFile, WithoutAMatrixIsRefusedUntilTold) {
  const TemporaryFolder folder;
  const std::string unstated = replaced(kMeta, "TransformMatrix = 0 1 0 -1 0 0 0 0 1\n", "") + big_shorts();
  expect_refused(read(folder, "v.mha", unstated), "no TransformMatrix");
  const auto told = read(folder, "v.mha", unstated, Space::ras);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->lattice.origin_mm, (PlainPoint{-5, -6, 7}));
}

TEST(MetaImageFile, BombsChannelsAndShortFilesAreRefused) {
  const TemporaryFolder folder;
  expect_refused(read(folder, "v.mha", replaced(kMeta, "3 2 2", "2000 2000 2000")),
                 "8000000000 voxels; up to 1000000000 are accepted");
  expect_refused(
      read(folder, "v.mha", replaced(kMeta, "NDims = 3\n", "NDims = 3\nElementNumberOfChannels = 3\n")),
      "3 numbers a voxel");
  expect_refused(read(folder, "v.mha", kMeta + std::string("0123")), "cut short");
  expect_refused(read(folder, "v.mha", replaced(kMeta, "3 2 2", "3 2 2 5")),
                 "has 4 dimensions; 3 are accepted");
}

TEST(VolumeReader, RefusesWhatSaysNothingOfItself) {
  const TemporaryFolder folder;
  expect_refused(read(folder, "quarter.1", std::string(8192, '\7')),
                 "voxels alone need a header beside them");
  expect_refused(read(folder, "empty.nii", ""), "is no volume");
  expect_refused(read_volume({.path = folder / "missing.nii.gz"}), "is not there");
}

TEST(VolumeReader, NumbersThatAreNoneBecomeTheLeast) {
  const TemporaryFolder folder;
  std::string floats;
  for (int i = 0; i < 12; ++i) {
    const float value = i == 3 ? NAN : static_cast<float>(i) - 2;
    floats.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const auto volume =
      read(folder, "v.mha",
           replaced(replaced(kMeta, "MSB = True", "MSB = False"), "MET_SHORT", "MET_FLOAT") + floats);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->values[3], -2);
  EXPECT_EQ(volume->notes.size(), 1U);
}

}  // namespace
}  // namespace orcart
