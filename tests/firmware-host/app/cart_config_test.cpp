// cart.toml: the shipped one loads, and what is wrong is told all at once, each with its line.
#include "firmware-host/app/cart_config.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/app/demo_cart.hpp"
#include "tests/firmware-host/files/temporary_folder.hpp"

namespace orcart::testing {
namespace {

/// The complaint about a cart of this text; empty where it is accepted.
std::string complaint(const std::string& text) {
  const TemporaryFolder folder;
  const auto config = read_cart(folder.write("cart.toml", text));
  return config ? std::string{} : config.error().message;
}

/// ":N:", the line of the first occurrence of `what` in a text.
std::string line_of(const std::string& text, const std::string& what) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(text.find(what));
  return ":" + std::to_string(1 + std::count(text.begin(), end, '\n')) + ":";
}

bool tells(const std::string& complaint, const std::string& what) {
  return complaint.find(what) != std::string::npos;
}

std::string complaint_of_view(const std::string& head, const std::string& view) {
  return complaint(head + "[view]\n" + view + "\n");
}

TEST(CartConfig, ReadsTheShippedDemo) {
  const auto config = read_cart(demo_cart());
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->tracker.rate_hz, 60);
  EXPECT_EQ(config->camera.width_px, 640);
  EXPECT_EQ(config->seen_from, SeenFrom::inside);
  EXPECT_EQ(config->mode, TextureMode::perspective);
  EXPECT_TRUE(config->simulated());
  for (const auto& file : {config->surface, config->scope, config->registration, config->tracker.scope_rom,
                           config->tracker.reference_rom})
    EXPECT_TRUE(std::filesystem::exists(file)) << file;
}

TEST(CartConfig, ReadsHowFarAnAngledScopeIsTurned) {
  EXPECT_FALSE(read_cart(demo_cart())->turn_rad);
  const TemporaryFolder folder;
  const std::string text = replaced(text_of(demo_cart()), "[scope]\n", "[scope]\nturn_deg = 45\n");
  const auto config = read_cart(folder.write("cart.toml", text));
  ASSERT_TRUE(config) << config.error().message;
  ASSERT_TRUE(config->turn_rad);
  EXPECT_NEAR(*config->turn_rad, 0.78539816339744828, 1e-12);
  EXPECT_TRUE(tells(complaint(replaced(text, "turn_deg = 45", "turn_deg = 450")), "turn_deg"));
}

TEST(CartConfig, ReadsHowPicturesArePutOntoTheSurface) {
  const TemporaryFolder folder;
  std::string text = replaced(text_of(demo_cart()), "policy = \"newest\"", "policy = \"best\"");
  text = replaced(text, "highlights = \"yield\"", "highlights = \"keep\"");
  text = replaced(text, "light = \"auto_exposure\"", "light = \"fixed_exposure\"");
  const auto config =
      read_cart(folder.write("cart.toml", replaced(text, "[view]\n", "[view]\ncolour_by = \"angle\"\n")));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->policy, PaintPolicy::best);
  EXPECT_EQ(config->highlights, Highlights::keep);
  EXPECT_EQ(config->light, LightModel::fixed_exposure);
  EXPECT_EQ(config->colour_by, ColourBy::angle);
}

TEST(CartConfig, TellsEveryErrorAtOnceWithItsLine) {
  std::string text = text_of(demo_cart());
  text = replaced(text, "rate_hz = 60", "rate_hz = 4000");
  text = replaced(text, "width_px = 640", "width_px = \"wide\"");
  text = replaced(text, "mode = \"perspective\"", "mode = \"cubist\"");
  text = replaced(text, "seed = 1", "sead = 1");
  ASSERT_FALSE(text.empty());
  const std::string told = complaint(text);
  for (const char* wrong : {"rate_hz = 4000", "width_px = \"wide\"", "mode = \"cubist\"", "sead = 1"})
    EXPECT_TRUE(tells(told, line_of(text, wrong))) << wrong << " in:\n" << told;
  EXPECT_TRUE(tells(told, "4000")) << told;
  EXPECT_TRUE(tells(told, "cubist")) << told;
  EXPECT_TRUE(tells(told, "sead")) << told;
}

TEST(CartConfig, RefusesAViewThatDoesNotTellWhereUpIs) {
  const std::string demo = text_of(demo_cart());
  const std::string head = demo.substr(0, demo.find("[view]"));
  ASSERT_LT(head.size(), demo.size());
  EXPECT_EQ(complaint_of_view(head, "from = [0, 1, 0]"), "");
  EXPECT_TRUE(tells(complaint_of_view(head, "from = [0, 0, 1]"), "[view] up lies along from"));
  EXPECT_TRUE(
      tells(complaint_of_view(head, "from = [1, 1, 0]\nup = [-2, -2, 0]"), "[view] up lies along from"));
  EXPECT_TRUE(tells(complaint_of_view(head, "from = [0, 0, 0]"), "[view] from is [0, 0, 0]"));
  EXPECT_TRUE(tells(complaint_of_view(head, "up = [0, 0, 0]"), "[view] up is [0, 0, 0]"));
}

TEST(CartConfig, RefusesAnExposureLongerThanThePeriod) {
  const std::string told = complaint(replaced(text_of(demo_cart()), "exposure_ms = 8", "exposure_ms = 40"));
  EXPECT_TRUE(tells(told, "exposure_ms")) << told;
  EXPECT_TRUE(tells(told, "33.3")) << told;
}

TEST(CartConfig, RefusesAnEmptyFileForWhatItLacks) {
  const std::string told = complaint("");
  for (const char* needed : {"surface", "scope", "registration", "tracker", "camera"})
    EXPECT_TRUE(tells(told, needed)) << needed << " in:\n" << told;
}

TEST(CartConfig, RefusesWhatIsNoToml) {
  EXPECT_NE(complaint("[tracker\nkind = simulated"), "");
  EXPECT_NE(complaint(std::string("\0\xff\xfe garbage", 11)), "");
}

TEST(CartConfig, NamesTheFileThatIsMissing) {
  const auto config = read_cart("/nowhere/cart.toml");
  ASSERT_FALSE(config);
  EXPECT_TRUE(tells(config.error().message, "/nowhere/cart.toml"));
}

TEST(CartConfig, FollowsAScopeThatTurnsByWhatIsThere) {
  const std::string angled = text_of(demo_cart().parent_path() / "demo-angled.toml");
  const TemporaryFolder folder;
  const auto config = read_cart(folder.write("cart.toml", angled));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->turn, TurnSource::marker);
  EXPECT_TRUE(config->tracker.second);
  EXPECT_EQ(config->tracker.second_rom.filename(), "second.rom");
  EXPECT_NEAR(config->simulation.turn_rad, 1.0472, 1e-4);
  EXPECT_NEAR(config->most_mismatch_rad, 0.034907, 1e-6);

  const std::string second = "second_rom = \"../tools/second.rom\"";
  EXPECT_TRUE(tells(complaint(replaced(angled, second, "")), "wants the second marker's definition"));
  const std::string by_notch = replaced(angled, "turn = \"marker\"", "turn = \"notch\"");
  EXPECT_TRUE(tells(complaint(by_notch), "nobody asks"));
  EXPECT_EQ(complaint(replaced(by_notch, second, "")), "");
  EXPECT_TRUE(tells(complaint(replaced(angled, "turn = \"marker\"", "turn = \"marker\"\nturn_deg = 10")),
                    "either told or followed"));
  EXPECT_TRUE(tells(complaint(replaced(angled, "turn = \"marker\"", "turn = \"guess\"")), "notch"));
  EXPECT_TRUE(
      tells(complaint(replaced(angled, "turn = \"marker\"", "turn = \"marker\"\nmost_mismatch_deg = 0")),
            "most_mismatch_deg"));
  EXPECT_FALSE(config->turn_deviation_rad);
  const auto told = read_cart(folder.write(
      "told.toml", replaced(angled, "turn = \"marker\"", "turn = \"marker\"\nturn_deviation_deg = 0.5")));
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_NEAR(told->turn_deviation_rad.value(), 0.0087266, 1e-7);
  EXPECT_TRUE(
      tells(complaint(replaced(angled, "turn = \"marker\"", "turn = \"marker\"\nturn_deviation_deg = -1")),
            "turn_deviation_deg"));
}

/// The angled demo, followed by an encoder of this section.
std::string by_encoder(const std::string& section) {
  std::string text = replaced(text_of(demo_cart().parent_path() / "demo-angled.toml"), "turn = \"marker\"",
                              "turn = \"encoder\"");
  return replaced(text, "second_rom = \"../tools/second.rom\"", "") + "\n[encoder]\n" + section;
}

TEST(CartConfig, FollowsAScopeThatTurnsByAnEncoder) {
  const TemporaryFolder folder;
  const auto config = read_cart(folder.write(
      "cart.toml", by_encoder("kind = \"evdev\"\ndevice = \"/dev/input/by-path/knob\"\naxis = \"rel_x\"\n"
                              "counts_per_turn = 2048\ncounts_rise = \"anticlockwise\"\n")));
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->turn, TurnSource::encoder);
  EXPECT_EQ(config->encoder.device.axis, "rel_x");
  EXPECT_NEAR(scale_of(config->encoder).rad_per_count, -0.0030679615757712823, 1e-15);
  EXPECT_TRUE(config->any_device());
}

TEST(CartConfig, RefusesAnEncoderThatCannotBe) {
  const std::string knob = "kind = \"evdev\"\ndevice = \"event3\"\ncounts_rise = \"clockwise\"\n";
  EXPECT_EQ(complaint(by_encoder(knob + "counts_per_turn = 2048\n")), "");
  EXPECT_TRUE(tells(complaint(by_encoder(knob + "counts_per_turn = 0\n")), "counts_per_turn"));
  EXPECT_TRUE(tells(complaint(by_encoder(knob)), "counts_per_turn"));
  EXPECT_TRUE(tells(complaint(by_encoder(knob + "counts_per_turn = 2048\naxis = \"dial\"\n")), "rel_dial"));
  EXPECT_TRUE(tells(complaint(by_encoder(knob + "counts_per_turn = 2048\ncounts_at_zero = 3\n")),
                    "knows no place of its own"));
  EXPECT_EQ(complaint(by_encoder(knob + "counts_per_turn = 2048\naxis = \"abs_x\"\ncounts_at_zero = 3\n")),
            "");
  EXPECT_TRUE(tells(complaint(by_encoder("kind = \"simulated\"\ncounts_per_turn = 2048\n"
                                         "counts_rise = \"anticlockwise\"\n")),
                    "rise clockwise"));
  EXPECT_TRUE(tells(complaint(replaced(by_encoder(knob + "counts_per_turn = 2048\n"), "turn = \"encoder\"",
                                       "turn = \"notch\"")),
                    "nobody asks"));
}

}  // namespace
}  // namespace orcart::testing
