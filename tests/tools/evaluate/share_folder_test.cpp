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
  std::filesystem::path surface, scope, registration, scope_rom, reference_rom;
  const auto taken = take_demo_files({surface, scope, registration, scope_rom, reference_rom});
  ASSERT_TRUE(taken) << taken.error().message;
  for (const auto* file : {&surface, &scope, &registration, &scope_rom, &reference_rom})
    EXPECT_TRUE(std::filesystem::is_regular_file(*file)) << *file;
  EXPECT_NE(taken->find("carts/demo-registration.toml"), std::string::npos);
}

TEST(DemoFiles, OfThePatientAreTakenAllOrNone) {
  std::filesystem::path surface = "mine.ply", scope, registration, scope_rom, reference_rom;
  const auto mixed = take_demo_files({surface, scope, registration, scope_rom, reference_rom});
  ASSERT_FALSE(mixed);
  EXPECT_NE(mixed.error().message.find("--surface without --registration, --reference-rom"),
            std::string::npos);
  registration = "mine.toml", reference_rom = "mine.rom";
  const auto own = take_demo_files({surface, scope, registration, scope_rom, reference_rom});
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(*own, "scopes/neuro-2p7.toml, tools/scope.rom");
  EXPECT_EQ(surface, "mine.ply");
  scope_rom.clear();
  EXPECT_FALSE(take_demo_files({surface, scope, registration, scope_rom, reference_rom}));
}

}  // namespace
}  // namespace orcart
