// A TOML file's mistakes are told all at once, each with its line and with what would be accepted.
#include "firmware-host/files/toml_reader.hpp"

#include <gtest/gtest.h>

#include "firmware-host/files/edit_distance.hpp"

namespace orcart {
namespace {

std::unique_ptr<TomlReader> reader_of(std::string_view text) {
  auto reader = TomlReader::parse(text, "/carts/cart.toml");
  EXPECT_TRUE(reader) << reader.error().message;
  return reader ? *std::move(reader) : nullptr;
}

enum class Colour { red, green };

TEST(TomlReader, GivesWhatTheFileSays) {
  const auto reader = reader_of(
      "title = \"x\"\n[tracker]\nrate_hz = 60\nport = \"/dev/ttyUSB0\"\nfile = \"a/b.rom\"\nkind = "
      "\"green\"\n"
      "count = 3\non = true\nnames = [\"a\", \"b\"]\npoint = [1, 2.5, -3]\n"
      "X_AB = [[1,0,0,4],[0,1,0,5],[0,0,1,6],[0,0,0,1]]\n[tracker.inner]\nx = 1\n[[tool]]\nname = \"s\"\n"
      "[[tool]]\nname = \"r\"\n");
  EXPECT_EQ(reader->top().text("title"), "x");
  const TomlSection tracker = reader->section("tracker");
  EXPECT_EQ(tracker.number("rate_hz", {.min = 20, .max = 400}), 60);
  EXPECT_EQ(tracker.path("port"), "/dev/ttyUSB0");
  EXPECT_EQ(tracker.path("file"), "/carts/a/b.rom");
  EXPECT_EQ(tracker.choice_of<Colour>("kind", {{"red", Colour::red}, {"green", Colour::green}}),
            Colour::green);
  EXPECT_EQ(tracker.integer("count"), 3);
  EXPECT_TRUE(tracker.flag("on"));
  EXPECT_EQ(tracker.texts("names"), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(tracker.numbers("point", 3), (std::vector<double>{1, 2.5, -3}));
  EXPECT_EQ(tracker.matrix_3x4("X_AB"), (std::array<double, 12>{1, 0, 0, 4, 0, 1, 0, 5, 0, 0, 1, 6}));
  EXPECT_EQ(tracker.section("inner").number("x"), 1);
  ASSERT_EQ(reader->sections("tool").size(), 2U);
  EXPECT_EQ(reader->sections("tool")[0].text("name"), "s");
  EXPECT_EQ(reader->sections("tool")[1].text("name"), "r");
  const auto finished = reader->finish();
  EXPECT_TRUE(finished) << finished.error().message;
}

TEST(TomlReader, UsesFallbacksWhereNothingIsSaid) {
  const auto reader = reader_of("");
  const TomlSection absent = reader->section("sync");
  EXPECT_FALSE(absent.present());
  EXPECT_EQ(absent.number("offset_ms", {.fallback = 7}), 7);
  const Colour colour =
      absent.choice_of<Colour>("kind", {{"red", Colour::red}, {"green", Colour::green}}, Colour::green);
  EXPECT_EQ(colour, Colour::green);
  EXPECT_TRUE(absent.flag("on", true));
  EXPECT_EQ(absent.text("name", "n"), "n");
  EXPECT_EQ(absent.path("file", "f"), "/carts/f");
  EXPECT_TRUE(reader->finish());
}

TEST(TomlReader, TellsEveryErrorInTheFilesOrder) {
  const auto reader = reader_of(
      "[tracker]\nrate_hz = \"fast\"\n\n[camera]\nfps = 3000\nformat = \"rgb\"\nX = [1, 2]\nratf_hz = "
      "2\n[cammera]\n");
  const TomlSection camera = reader->section("camera");
  camera.number("fps", {.min = 1, .max = 240});
  camera.choice("format", {"yuyv", "nv12"});
  camera.matrix_3x4("X");
  camera.number("rate_hz", {.fallback = 1});
  camera.text("device");
  reader->section("tracker").number("rate_hz", {.min = 20, .max = 400});
  const auto finished = reader->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().message,
            "/carts/cart.toml:2: [tracker] rate_hz is \"fast\"; a number from 20 to 400 is accepted\n"
            "/carts/cart.toml:4: [camera] device is missing; it is required\n"
            "/carts/cart.toml:5: [camera] fps is 3000; a number from 1 to 240 is accepted\n"
            "/carts/cart.toml:6: [camera] format is \"rgb\"; \"yuyv\" or \"nv12\" is accepted\n"
            "/carts/cart.toml:7: [camera] X has 2 numbers; a 3x4 matrix, 12 numbers row by row (or 16 ending "
            "in 0 0 0 1), "
            "is accepted\n"
            "/carts/cart.toml:8: [camera] ratf_hz is not known; did you mean rate_hz?\n"
            "/carts/cart.toml:9: [cammera] is not known; did you mean camera?");
}

struct Wrong {
  const char* text;
  const char* expected;
};

class WrongValue : public testing::TestWithParam<Wrong> {};
INSTANTIATE_TEST_SUITE_P(
    Values, WrongValue,
    testing::Values(Wrong{"n = nan", "n is nan; a number of 0 or more is accepted"},
                    Wrong{"n = -1", "n is -1; a number of 0 or more is accepted"},
                    Wrong{"n = true", "n is true; a number"},
                    Wrong{"n = [1]", "a number of 0 or more is accepted"},
                    Wrong{"i = 1.5", "i is 1.5; a whole number from 0 to 9 is accepted"},
                    Wrong{"i = 10", "i is 10; a whole number from 0 to 9"},
                    Wrong{"t = \"\"", "t is \"\"; a text in quotes, not empty, is accepted"},
                    Wrong{"t = 5", "t is 5; a text in quotes"},
                    Wrong{"f = 1", "f is 1; true or false is accepted"},
                    Wrong{"v = [1, \"x\"]", "a list of 2 numbers is accepted"},
                    Wrong{"v = [1, inf]", "a list of 2 numbers is accepted"},
                    Wrong{"v = [1]", "v has 1 numbers; a list of 2 numbers is accepted"},
                    Wrong{"s = 3", "s is 3; a section [s] is accepted"},
                    Wrong{"l = [1]", "one or more sections [[l]] is accepted"},
                    Wrong{"w = [1]", "a list of texts is accepted"},
                    Wrong{"m = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]", "ends in another row than 0 0 0 1"}));

TEST_P(WrongValue, IsShownWithWhatWouldBeAccepted) {
  const auto reader = reader_of(GetParam().text);
  const TomlSection top = reader->top();
  top.number("n", {.min = 0, .fallback = 0});
  top.integer("i", {.min = 0, .max = 9, .fallback = 0});
  top.text("t", "x");
  top.flag("f", false);
  top.numbers("v", 2, std::vector<double>{0, 0});
  top.texts("w", std::vector<std::string>{});
  top.matrix_3x4("m", std::array<double, 12>{});
  top.section("s");
  top.sections("l");
  const auto finished = reader->finish();
  ASSERT_FALSE(finished);
  const std::string& message = finished.error().message;
  EXPECT_NE(message.find(GetParam().expected), std::string::npos) << message;
  EXPECT_TRUE(message.starts_with("/carts/cart.toml:1: ")) << message;
}

TEST(TomlReader, UnknownKeysAreFoundInTablesAndInArraysOfTables) {
  const auto reader = reader_of("[a]\n[a.b]\nx = 1\n[[t]]\ny = 1\n");
  reader->section("a").section("b");
  reader->sections("t");
  const auto finished = reader->finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().message,
            "/carts/cart.toml:3: [a.b] x is not known; remove it\n/carts/cart.toml:5: [t] y is not known; "
            "remove it");
}

TEST(TomlReader, WhatIsNoTomlSaysTheLine) {
  const auto reader = TomlReader::parse("a = 1\nb = = 2\n", "cart.toml");
  ASSERT_FALSE(reader);
  EXPECT_TRUE(reader.error().message.starts_with("cart.toml:2: is not valid TOML: "))
      << reader.error().message;
}

TEST(TomlReader, AMissingFileSaysSo) {
  const auto reader = TomlReader::open("/nowhere/cart.toml");
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().message, "/nowhere/cart.toml: cannot be read: No such file or directory");
}

TEST(TomlReader, KeepsTheCallersOwnErrorsAndNotes) {
  const auto reader = reader_of("[a]\nx = 1\n");
  const TomlSection a = reader->section("a");
  a.number("x");
  a.note("x", "was rounded");
  a.refuse("x", "is odd; an even number is accepted");
  EXPECT_EQ(reader->notes(), std::vector<std::string>{"/carts/cart.toml:2: [a] x was rounded"});
  EXPECT_EQ(reader->finish().error().message, "/carts/cart.toml:2: [a] x is odd; an even number is accepted");
}

TEST(EditDistance, CountsTheFewestChanges) {
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("same", "same"), 0U);
}

TEST(EditDistance, SuggestsOnlyWhatIsNear) {
  const std::vector<std::string> known{"rate_hz", "port", "baud"};
  EXPECT_EQ(did_you_mean("rat_hz", known), "rate_hz");
  EXPECT_EQ(did_you_mean("ports", known), "port");
  EXPECT_EQ(did_you_mean("exposure", known), "");
}

}  // namespace
}  // namespace orcart
