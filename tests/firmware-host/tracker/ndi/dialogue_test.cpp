// Recorded dialogues in their three notations.
#include "firmware-host/tracker/ndi/dialogue_figures.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/tracker/ndi/wire_samples.hpp"

namespace orcart::ndi {
namespace {

void expect_init_and_okay(const Result<Dialogue>& dialogue) {
  ASSERT_TRUE(dialogue);
  ASSERT_EQ(dialogue->size(), 2u);
  EXPECT_EQ((*dialogue)[0].speaker, Speaker::host);
  EXPECT_EQ((*dialogue)[0].bytes, "INIT:E3A5\r");
  EXPECT_EQ((*dialogue)[1].bytes, "OKAYA896\r");
}

TEST(Dialogue, IsReadInEachNotation) {
  expect_init_and_okay(parse_dialogue(
      "11.4 : (INFO) 1. command[10] INIT:E3A5\\x0D\n11.5 : (INFO) 1. receive[9] OKAYA896\\x0D\n", "log"));
  expect_init_and_okay(
      parse_dialogue("# recorded\n\n1. command[10] INIT:E3A5\n1. receive[9] OKAYA896\n", "bin"));
  expect_init_and_okay(parse_dialogue("sent:0001 = INIT:E3A5\nrecv:0001 = OKAYA896\nsent:0002 = \n", "text"));
}

TEST(Dialogue, IsReadWhateverStandsInFrontOfARecordAndHoweverLinesEnd) {
  expect_init_and_okay(
      parse_dialogue("[12:00:01.4] DEBUG 1. command[10] INIT:E3A5\\x0d\r\n[12:00:01.5] DEBUG 1. receive[9] "
                     "OKAYA896\\x0d\r\n",
                     "log"));
  expect_init_and_okay(parse_dialogue("command[10] INIT:E3A5\\x0D\nreceive[9] OKAYA896\\x0D", "log"));
  expect_init_and_okay(parse_dialogue("1. command[10] INIT:E3A5\r\n1. receive[9] OKAYA896\r\n", "bin"));
  expect_init_and_okay(parse_dialogue("2012 sent:0001 = INIT:E3A5\r\n2012 recv:0001 = OKAYA896", "text"));
  expect_init_and_okay(parse_dialogue("sent:1 = INIT:E3A5\\x0D\nrecv:1 = OKAYA896\\x0D\n", "text"));
}

TEST(Dialogue, DoesNotBelieveALengthThatLineEndsHaveMadeWrong) {
  const auto dialogue = parse_dialogue(
      "1. command[9] VER:4A6EF\r\n1. receive[13] Polaris\r\n12A4\r\n2. command[10] INIT:E3A5\r\n", "bin");
  ASSERT_TRUE(dialogue);
  ASSERT_EQ(dialogue->size(), 3u);
  EXPECT_EQ((*dialogue)[2].bytes.substr(0, 9), "INIT:E3A5");
}

TEST(Dialogue, TakesATextModesCarriageReturnsOutOfABinaryRecording) {
  const auto with_carriage_returns = [](std::string_view text) {
    std::string longer;
    for (const char letter : text) longer += letter == '\n' ? "\r\n" : std::string(1, letter);
    return longer;
  };
  const std::string version = testing::framed("Polaris\nS/N: P4\n001.026");
  const std::string pose = testing::framed_binary("\x01\x02\x0A\x03\x0D\x0A\x0A");
  const std::string recording = "1. receive[" + std::to_string(version.size()) + "] " + version +
                                "2. receive[" + std::to_string(pose.size()) + "] " + pose +
                                "3. command[10] INIT:E3A5\r";
  const auto dialogue = parse_dialogue(with_carriage_returns(recording), "bin");
  ASSERT_TRUE(dialogue);
  ASSERT_EQ(dialogue->size(), 3u);
  EXPECT_EQ((*dialogue)[0].bytes, version);
  EXPECT_EQ((*dialogue)[1].bytes, pose);
  EXPECT_EQ((*dialogue)[2].bytes, "INIT:E3A5\r");
}

TEST(Dialogue, CountsNoCrcOfAMessageThatTheRecordingCutsOff) {
  for (const std::string_view end : {"1. receive[9] OKAY", "1. receive[9] OKAYA8"}) {
    const auto dialogue = parse_dialogue("1. command[10] INIT:E3A5\\x0D\n" + std::string(end), "log");
    ASSERT_TRUE(dialogue);
    const DialogueFigures figures = count_dialogue(*dialogue);
    EXPECT_EQ(figures.replies, 1u);
    EXPECT_EQ(figures.crc_good, 1u);
    EXPECT_EQ(figures.crc_bad, 0u);
    ASSERT_EQ(figures.remarks.size(), 1u);
    EXPECT_NE(figures.remarks[0].find("the recording ends"), std::string::npos);
  }
}

TEST(Dialogue, CountsPosesOfEveryCommandThatTellsThem) {
  const std::string transform = "+09999+00001+00002-00003-012345+001234-150000+00123";
  const std::string gx = transform + "\nMISSING\nUNOCCUPIED\n00000031";
  const std::string tx = "0201" + transform + "0000003100000001" + "7F0C\n02DISABLED\n0000";
  const std::string text = "sent:1 = " + testing::framed("GX:0001") + "\nrecv:1 = " + testing::framed(gx) +
                           "\nsent:2 = " + testing::framed("TX:4001") + "\nrecv:2 = " + testing::framed(tx) +
                           "\n";
  const auto dialogue = parse_dialogue(text, "text");
  ASSERT_TRUE(dialogue);
  const DialogueFigures figures = count_dialogue(*dialogue);
  EXPECT_EQ(figures.crc_good, 4u);
  EXPECT_EQ(figures.crc_bad, 0u);
  EXPECT_EQ(figures.transforms, 2u);
  EXPECT_EQ(figures.missing, 1u);
  EXPECT_EQ(figures.disabled, 2u);
}

TEST(Dialogue, JoinsLinesOfOneReply) {
  const auto dialogue = parse_dialogue("sent:0001 = VER:4A6EF\nrecv:0001 = Polaris\nE2CA\n", "text");
  ASSERT_TRUE(dialogue);
  EXPECT_EQ(dialogue->back().bytes, "Polaris\nE2CA\r");
}

TEST(Dialogue, ThatHoldsNothingIsRefused) {
  for (const std::string_view content :
       {std::string_view{}, std::string_view{"hello"}, std::string_view{". command["},
        std::string_view{"1. command[99999999999] x"}}) {
    EXPECT_FALSE(parse_dialogue(content, "x"));
  }
}

TEST(Dialogue, IsSafeWhereverItIsCutShort) {
  const std::string whole =
      "1. command[12] BX:0001C26D\n1. receive[31] " + testing::kTwoMissing + "\n2. command[10] INIT:E3A5\n";
  for (std::size_t size = 0; size <= whole.size(); ++size) {
    const auto dialogue = parse_dialogue(std::string_view(whole).substr(0, size), "x");
    if (dialogue) (void)count_dialogue(*dialogue);
  }
}

TEST(DialogueFigures, CountCommandsRepliesAndWhatTheySay) {
  const Dialogue dialogue{{Speaker::host, 1, "BX:0001C26D\r"}, {Speaker::device, 1, testing::kOneSeen},
                          {Speaker::host, 2, "PDIS:03D3E7\r"}, {Speaker::device, 2, "ERROR086D02\r"},
                          {Speaker::host, 3, "INIT:0000\r"},   {Speaker::host, 4, "INIT:E3A5\r"},
                          {Speaker::device, 4, "OKAYA896"}};
  const DialogueFigures figures = count_dialogue(dialogue);
  EXPECT_EQ(figures.commands, 4u);
  EXPECT_EQ(figures.replies, 3u);
  EXPECT_EQ(figures.crc_good, 7u);
  EXPECT_EQ(figures.crc_bad, 1u);
  EXPECT_EQ(figures.transforms, 1u);
  EXPECT_EQ(figures.missing, 1u);
  EXPECT_EQ(figures.errors, 1u);
  EXPECT_EQ(figures.unanswered, 2u);
  EXPECT_EQ(figures.remarks.size(), 4u);
}

TEST(Dialogue, AFolderIsRefusedInASentence) {
  const auto dialogue = read_dialogue(std::filesystem::temp_directory_path());
  ASSERT_FALSE(dialogue);
  EXPECT_NE(dialogue.error().message.find("a readable file is wanted"), std::string::npos);
}

}  // namespace
}  // namespace orcart::ndi
