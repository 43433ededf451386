// Replies found in bytes that come in pieces, damaged, with noise before them, or never.
#include "firmware-host/tracker/ndi/framing.hpp"

#include <gtest/gtest.h>

#include "tests/firmware-host/tracker/ndi/wire_samples.hpp"

namespace orcart::testing {
namespace {

using ndi::FrameStatus;

TEST(AsciiFraming, FindsTheTextOfAGoodReply) {
  const auto frame = ndi::find_ascii_reply(bytes_of("OKAYA896\r"));
  EXPECT_EQ(frame.status, FrameStatus::complete);
  EXPECT_EQ(frame.text(), "OKAY");
  EXPECT_EQ(frame.consumed, 9u);
}

TEST(AsciiFraming, WaitsForMoreWhereverTheReplyIsSplit) {
  const std::string message = framed("0301MISSING000000310000018B");
  for (std::size_t size = 0; size < message.size(); ++size) {
    EXPECT_EQ(ndi::find_ascii_reply(bytes_of(message).first(size)).status, FrameStatus::incomplete) << size;
  }
}

TEST(AsciiFraming, SeesEverySingleDamagedBit) {
  const std::string good = framed("RESET");
  for (std::size_t bit = 0; bit < 8 * (good.size() - 1); ++bit) {
    std::string bad = good;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ 1 << bit % 8);
    const bool digit_case_only = bit / 8 >= 5 && bit % 8 == 5 && good[bit / 8] >= 'A';
    if (digit_case_only) continue;  // a hex digit in lower case is the same number
    EXPECT_NE(ndi::find_ascii_reply(bytes_of(bad)).status, FrameStatus::complete) << bit;
  }
}

TEST(AsciiFraming, RefusesWhatIsTooShortForACrc) {
  EXPECT_EQ(ndi::find_ascii_reply(bytes_of("OK\r")).status, FrameStatus::bad_crc);
  EXPECT_EQ(ndi::find_ascii_reply(bytes_of("\r")).status, FrameStatus::bad_crc);
}

TEST(AsciiFraming, GivesUpOnWhatIsTooLong) {
  EXPECT_EQ(ndi::find_ascii_reply(bytes_of(std::string(3000, 'A'))).status, FrameStatus::garbage);
}

TEST(BinaryFraming, FindsTheRepliesOfARealDevice) {
  for (const std::string& message : {kTwoMissing, kOneSeen}) {
    const auto frame = ndi::find_binary_reply(bytes_of(message));
    EXPECT_EQ(frame.status, FrameStatus::complete);
    EXPECT_EQ(frame.payload.size(), message.size() - 8);
    EXPECT_EQ(frame.consumed, message.size());
  }
}

TEST(BinaryFraming, WaitsForMoreWhereverTheReplyIsSplit) {
  for (std::size_t size = 0; size < kOneSeen.size(); ++size) {
    EXPECT_EQ(ndi::find_binary_reply(bytes_of(kOneSeen).first(size)).status, FrameStatus::incomplete) << size;
  }
}

TEST(BinaryFraming, NeverTakesADamagedReplyForAGoodOne) {
  for (std::size_t bit = 0; bit < 8 * kTwoMissing.size(); ++bit) {
    std::string bad = kTwoMissing;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ 1 << bit % 8);
    EXPECT_NE(ndi::find_binary_reply(bytes_of(bad)).status, FrameStatus::complete) << bit;
  }
}

TEST(BinaryFraming, PassesOverNoiseInFrontOfAReply) {
  const std::string noise = "\x01\xC4zz\xC4\xA5xxxx";
  const auto frame = ndi::find_binary_reply(bytes_of(noise + kOneSeen));
  EXPECT_EQ(frame.status, FrameStatus::complete);
  EXPECT_EQ(frame.skipped, noise.size());
}

TEST(BinaryFraming, CallsNoiseAloneGarbage) {
  EXPECT_EQ(ndi::find_binary_reply(bytes_of("nothing of the kind")).status, FrameStatus::garbage);
}

TEST(BinaryFraming, RefusesALengthThatNoReplyHas) {
  std::string header = "\xC4\xA5\xFF\xFF";
  const unsigned crc = crc16(header);
  header += static_cast<char>(crc & 0xFFu);
  header += static_cast<char>(crc >> 8);
  EXPECT_EQ(ndi::find_binary_reply(bytes_of(header)).status, FrameStatus::garbage);
}

TEST(BinaryFraming, FindsAnErrorThatIsAnsweredInText) {
  const auto frame = ndi::find_binary_reply(bytes_of("ERROR016BC2\r"));
  EXPECT_EQ(frame.status, FrameStatus::complete);
  EXPECT_EQ(frame.kind, ndi::ReplyKind::ascii);
  EXPECT_EQ(frame.text(), "ERROR01");
}

TEST(BinaryFraming, TakesTheHeaderWithALongLength) {
  std::string message = "\xC8\xA5";
  message += std::string("\x03\x00\x00\x00", 4);
  const unsigned crc = crc16(message);
  message += static_cast<char>(crc & 0xFFu);
  message += static_cast<char>(crc >> 8);
  message += "abc";
  const unsigned body = crc16(std::string_view("abc"));
  message += static_cast<char>(body & 0xFFu);
  message += static_cast<char>(body >> 8);
  const auto frame = ndi::find_binary_reply(bytes_of(message));
  EXPECT_EQ(frame.status, ndi::FrameStatus::complete);
  EXPECT_EQ(frame.text(), "abc");
  EXPECT_EQ(frame.consumed, message.size());
  for (std::size_t size = 0; size < message.size(); ++size)
    EXPECT_NE(ndi::find_binary_reply(bytes_of(message).first(size)).status, ndi::FrameStatus::complete);
}

}  // namespace
}  // namespace orcart::testing
