// FreeSurfer's MGH: numbers, places, and what is wrong with a file. The sample is checked by hand.
#include <zlib.h>

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"
#include "tools/volume/volume_reader.hpp"

namespace orcart {
namespace {

/// 4 x 3 x 2 voxels of int16 that count up; FreeSurfer's usual coronal axes (x to the left, y down, z
/// forward), 0.5 x 1 x 2 mm, the middle at RAS (1, 2, 3).
struct Mgh {
  std::string bytes = std::string(284, '\0');

  Mgh() {
    const std::int32_t words[] = {1, 4, 3, 2, 1, 4, 0};
    for (std::size_t i = 0; i < 7; ++i) put(4 * i, words[i]);
    put<std::int16_t>(28, 1);
    const float numbers[] = {0.5F, 1, 2, -1, 0, 0, 0, 0, -1, 0, 1, 0, 1, 2, 3};
    for (std::size_t i = 0; i < 15; ++i) put(30 + 4 * i, numbers[i]);
    bytes.resize(284 + 48);
    for (std::int16_t i = 0; i < 24; ++i) put<std::int16_t>(284 + 2 * static_cast<std::size_t>(i), i);
    bytes += std::string(20, '\1');  // what FreeSurfer writes behind the voxels
  }
  template <class Number>
  Mgh& put(std::size_t at, Number value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    std::reverse(raw, raw + sizeof value);
    bytes.replace(at, sizeof value, raw, sizeof value);
    return *this;
  }
};

Result<Volume> read(const std::string& bytes, std::optional<Space> space = std::nullopt) {
  const TemporaryFolder folder;
  return read_volume({.path = folder.write("brain.mgz", bytes), .where_unstated = space});
}

void expect_refused(const Result<Volume>& volume, const std::string& why) {
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().message.find(why), std::string::npos) << volume.error().message;
}

TEST(MghFile, ItsAxesAndItsMiddleAreTurnedFromRasToLps) {
  const auto volume = read(Mgh().bytes);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.size, (std::array{4, 3, 2}));
  EXPECT_EQ(volume->lattice.step_mm[0], (PlainPoint{0.5, 0, 0}));
  EXPECT_EQ(volume->lattice.step_mm[1], (PlainPoint{0, 0, -1}));
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, -2, 0}));
  EXPECT_EQ(volume->lattice.origin_mm, (PlainPoint{-2, 0, 4.5}));
  EXPECT_EQ(place_of(volume->lattice, {2, 1.5, 1}), (PlainPoint{-1, -2, 3}));  // the middle, LPS
  EXPECT_EQ(volume->values[13], 13);
  EXPECT_EQ(volume->kind, "MGH, int16");
}

TEST(MghFile, MayBeGzipped) {
  const TemporaryFolder folder;
  const auto file = folder / "brain.mgz";
  const gzFile out = gzopen(file.c_str(), "wb");
  const std::string bytes = Mgh().bytes;
  gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(out);
  const auto volume = read_volume({.path = file}), same = read(bytes);
  ASSERT_TRUE(volume && same) << volume.error().message;
  EXPECT_EQ(volume->values, same->values);
}

TEST(MghFile, EachTypeOfNumberIsRead) {
  for (const auto& [type, bytes] : {std::pair{0, 1}, {1, 4}, {3, 4}, {10, 2}}) {
    Mgh file;
    file.put<std::int32_t>(20, type);
    file.bytes.resize(284);
    file.bytes.append(static_cast<std::size_t>(24 * bytes), '\0');
    const std::size_t last = file.bytes.size() - static_cast<std::size_t>(bytes);
    if (type == 0) file.put<std::uint8_t>(last, 200);
    if (type == 1) file.put<std::int32_t>(last, -70'000);
    if (type == 3) file.put<float>(last, 0.25F);
    if (type == 10) file.put<std::uint16_t>(last, 40'000);
    const auto volume = read(file.bytes);
    ASSERT_TRUE(volume) << volume.error().message;
    const float expected = type == 0 ? 200 : type == 1 ? -70'000 : type == 3 ? 0.25F : 40'000;
    EXPECT_EQ(volume->values.back(), expected);
    EXPECT_EQ(volume->values.front(), 0);
  }
}

TEST(MghFile, ThatStatesNoSpaceIsRefusedUntilTold) {
  Mgh file;
  file.put<std::int16_t>(28, 0);
  expect_refused(read(file.bytes), "states no patient coordinates (its goodRASFlag is not set)");
  const auto volume = read(file.bytes, Space::lps);
  ASSERT_TRUE(volume) << volume.error().message;
  EXPECT_EQ(volume->lattice.step_mm[2], (PlainPoint{0, 0, 2}));
}

TEST(MghFile, OtherTypesSeveralVolumesAndShortFilesAreRefused) {
  expect_refused(read(Mgh().put<std::int32_t>(20, 7).bytes), "voxels of MGH type 7");
  expect_refused(read(Mgh().put<std::int32_t>(16, 3).bytes), "has 3 volumes in one file");
  expect_refused(read(Mgh().put<float>(30, 0).bytes), "do not span a space");
  const std::string whole = Mgh().bytes;
  for (std::size_t length = 0; length < whole.size() - 20; length += 5)
    EXPECT_FALSE(read(whole.substr(0, length)));
}

}  // namespace
}  // namespace orcart
