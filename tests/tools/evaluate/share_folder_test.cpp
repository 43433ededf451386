// The demo's files are found from where the program stands, installed or built.
#include "tools/evaluate/share_folder.hpp"

#include <unistd.h>

#include <gtest/gtest.h>

namespace orcart {
namespace {

TEST(ShareFolder, IsFoundBesideAnInstalledProgramAndInASourceTree) {
  const auto root = std::filesystem::temp_directory_path() / ("orcart-share-" + std::to_string(::getpid()));
  for (const char* folder :
       {"usr/bin", "usr/share/orcart/surfaces", "usr/share/orcart/scopes", "usr/share/surfaces",
        "tree/build/dev/tools/orcart", "tree/share/surfaces", "tree/share/scopes", "bare"})
    std::filesystem::create_directories(root / folder);
  EXPECT_EQ(share_folder(root / "usr/bin/orcart"), root / "usr/share/orcart");
  EXPECT_EQ(share_folder(root / "tree/build/dev/tools/orcart/orcart"), root / "tree/share");
  EXPECT_NE(share_folder(root / "bare/orcart"), root / "tree/share");
  EXPECT_TRUE(share_folder("").empty());
  std::filesystem::remove_all(root);
}

TEST(ShareFolder, OfThisProgramIsKnown) {
  EXPECT_TRUE(std::filesystem::exists(this_program()));
}

TEST(DemoFiles, TakeThePlaceOfWhatWasNotTold) {
  std::filesystem::path surface = "mine.ply", scope, registration, scope_rom, reference_rom;
  ASSERT_TRUE(take_demo_files({surface, scope, registration, scope_rom, reference_rom}));
  EXPECT_EQ(surface, "mine.ply");
  for (const auto* file : {&scope, &registration, &scope_rom, &reference_rom})
    EXPECT_TRUE(std::filesystem::is_regular_file(*file)) << *file;
}

}  // namespace
}  // namespace orcart
