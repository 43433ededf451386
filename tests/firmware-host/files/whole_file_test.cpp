// Files appear whole or not at all, and a failure leaves nothing behind.
#include "firmware-host/files/whole_file.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart {
namespace {

TEST(WholeFile, IsReadBackAsWritten) {
  const TemporaryFolder folder;
  const std::string_view text("a\0b\n", 4);
  ASSERT_TRUE(write_whole_file(folder / "f", text));
  const auto bytes = read_whole_file(folder / "f", 100);
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(bytes->data()), bytes->size()), text);
  EXPECT_EQ(folder.count(), 1U);
}

TEST(WholeFile, ReplacesAnOlderOne) {
  const TemporaryFolder folder;
  folder.write("f", "old and longer");
  ASSERT_TRUE(write_whole_file(folder / "f", "new"));
  EXPECT_EQ(read_whole_file(folder / "f", 100)->size(), 3U);
}

TEST(WholeFile, LeavesNothingWhereItCannotBeWritten) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "taken");
  folder.write("taken/inside", "x");
  const auto written = write_whole_file(folder / "taken", "text");
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("taken: cannot be written: "), std::string::npos);
  EXPECT_EQ(folder.count(), 1U);
  EXPECT_FALSE(write_whole_file(folder / "no/such/folder", "text"));
}

TEST(WholeFile, RefusesOneThatIsTooLongOrNoFile) {
  const TemporaryFolder folder;
  const auto read = read_whole_file(folder.write("f", "12345"), 4);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("is 5 bytes long; up to 4 are accepted"), std::string::npos);
  EXPECT_FALSE(read_whole_file("/dev/zero", 100));
}

}  // namespace
}  // namespace orcart
