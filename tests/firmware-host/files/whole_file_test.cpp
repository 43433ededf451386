// Files appear whole or not at all, and a failure leaves nothing behind.
#include "firmware-host/files/whole_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>

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

TEST(WholeFile, ALinkStaysALinkAndItsFileIsReplaced) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "far");
  folder.write("far/scope.toml", "old");
  std::filesystem::create_symlink("far/scope.toml", folder / "near");
  std::filesystem::create_symlink("near", folder / "nearer");
  ASSERT_TRUE(write_whole_file(folder / "nearer", "new text"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "near"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "nearer"));
  EXPECT_FALSE(std::filesystem::is_symlink(folder / "far/scope.toml"));
  EXPECT_EQ(read_whole_file(folder / "far/scope.toml", 100)->size(), 8U);
  std::filesystem::create_symlink("far/fresh", folder / "dangling");
  ASSERT_TRUE(write_whole_file(folder / "dangling", "text"));
  EXPECT_EQ(read_whole_file(folder / "far/fresh", 100)->size(), 4U);
  EXPECT_EQ(folder.count(), 4U);
}

TEST(WholeFile, APipeIsWrittenIntoAndStaysOne) {
  const TemporaryFolder folder;
  const auto pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto unread = write_whole_file(pipe, "text");
  ASSERT_FALSE(unread);
  EXPECT_NE(unread.error().message.find("pipe: cannot be written: nobody reads it"), std::string::npos);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  EXPECT_TRUE(write_whole_file(pipe, "text"));
  std::array<char, 8> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 4);
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  EXPECT_EQ(folder.count(), 1U);
  EXPECT_TRUE(write_whole_file("/dev/null", "text"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
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
