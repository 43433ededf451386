// TX and BX replies: those of real devices, and every way in which one may end too early or go on too long.
#include "firmware-host/tracker/ndi/tracking_reply.hpp"

#include <gtest/gtest.h>

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/framing.hpp"
#include "tests/firmware-host/tracker/ndi/wire_samples.hpp"

namespace orcart::testing {
namespace {

using ndi::HandleStatus;
using ndi::ReplyFault;

std::string_view body_of(const std::string& message) {
  return std::string_view(message).substr(6, message.size() - 8);
}

// A Polaris, 2005: one tool missing, one seen, one seen.
constexpr std::string_view kText =
    "0301MISSING000000310000018B\n"
    "02+01687-04055+07178+05401-004630+030103-165893+00395000000310000018C\n"
    "03DISABLED\n0002";

TEST(BxReply, TellsWhatARealDeviceSaid) {
  const auto reply = ndi::parse_bx(bytes_of(body_of(kOneSeen)), ndi::kTransforms);
  ASSERT_TRUE(reply);
  ASSERT_EQ(reply->count, 2u);
  EXPECT_EQ(reply->handles[0].status, HandleStatus::missing);
  EXPECT_EQ(reply->handles[0].frame, 0x128u);
  const ndi::HandleReading& seen = reply->handles[1];
  EXPECT_EQ(seen.handle, 2);
  EXPECT_TRUE(seen.has_transform);
  EXPECT_NEAR(seen.quaternion[0], 0.5592F, 1e-4F);
  EXPECT_NEAR(seen.translation_mm[2], -2199.99F, 0.01F);
  EXPECT_NEAR(seen.error_mm, 0.0338F, 1e-4F);
  EXPECT_EQ(seen.port_status, 0x31u);
  EXPECT_EQ(seen.frame, 0x12Au);
  EXPECT_EQ(reply->system_status, 0);
}

TEST(BxReply, OfADisabledToolEndsBehindItsStatus) {
  const std::string body("\x02\x01\x04\x02\x04\x02\x00", 7);
  const auto reply = ndi::parse_bx(bytes_of(body), ndi::kTransforms);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->handles[1].status, HandleStatus::disabled);
  EXPECT_EQ(reply->system_status, 2);
}

TEST(BxReply, IsRefusedWhereverItIsCutShort) {
  const std::string_view body = body_of(kOneSeen);
  for (std::size_t size = 0; size < body.size(); ++size) {
    const auto reply = ndi::parse_bx(bytes_of(body).first(size), ndi::kTransforms);
    ASSERT_FALSE(reply) << size;
    EXPECT_EQ(reply.error(), ReplyFault::truncated) << size;
  }
}

TEST(BxReply, IsRefusedWhereItGoesOnTooLong) {
  const std::string body = std::string(body_of(kOneSeen)) + "x";
  EXPECT_EQ(ndi::parse_bx(bytes_of(body), ndi::kTransforms).error(), ReplyFault::trailing);
}

TEST(BxReply, IsRefusedForTooManyHandlesAndForAStatusThatDoesNotExist) {
  EXPECT_EQ(ndi::parse_bx(bytes_of("\xFF\x01\x04"), ndi::kTransforms).error(), ReplyFault::too_many_handles);
  EXPECT_EQ(ndi::parse_bx(bytes_of(std::string("\x01\x01\x03\x00\x00", 5)), ndi::kTransforms).error(),
            ReplyFault::bad_number);
}

TEST(BxReply, PassesOverWhatOtherOptionsAddToIt) {
  std::string body("\x01\x01\x02", 3);
  body += std::string("\x31\x00\x00\x00\x05\x00\x00\x00", 8);  // port status, frame
  body += std::string(11, '\0');                               // tool information
  body += std::string("\x01", 1) + std::string(12, '\0');      // a single stray marker
  body += std::string("\x02\x00", 2) + std::string(24, '\0');  // two marker positions
  body += std::string("\x01\x00", 2) + std::string(12, '\0');  // one passive stray
  body += std::string("\x00\x00", 2);
  const auto reply = ndi::parse_bx(bytes_of(body), 0x100F);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->handles[0].frame, 5u);
}

TEST(TxReply, TellsWhatARealDeviceSaid) {
  const auto reply = ndi::parse_tx(kText, ndi::kTransforms);
  ASSERT_TRUE(reply);
  ASSERT_EQ(reply->count, 3u);
  EXPECT_EQ(reply->handles[0].status, HandleStatus::missing);
  EXPECT_EQ(reply->handles[0].frame, 0x18Bu);
  EXPECT_FLOAT_EQ(reply->handles[1].quaternion[1], -0.4055F);
  EXPECT_FLOAT_EQ(reply->handles[1].translation_mm[2], -1658.93F);
  EXPECT_FLOAT_EQ(reply->handles[1].error_mm, 0.0395F);
  EXPECT_EQ(reply->handles[1].port_status, 0x31u);
  EXPECT_EQ(reply->handles[2].status, HandleStatus::disabled);
  EXPECT_EQ(reply->system_status, 2);
}

TEST(TxReply, IsRefusedWhereverItIsCutShort) {
  for (std::size_t size = 0; size < kText.size(); ++size) {
    EXPECT_FALSE(ndi::parse_tx(kText.substr(0, size), ndi::kTransforms)) << size;
  }
}

TEST(TxReply, IsRefusedWithLettersForDigitsOrALineTooMany) {
  std::string garbled(kText);
  garbled.replace(garbled.find("030103"), 6, "GARBAG");
  EXPECT_FALSE(ndi::parse_tx(garbled, ndi::kTransforms));
  EXPECT_EQ(ndi::parse_tx(std::string(kText) + "0", ndi::kTransforms).error(), ReplyFault::trailing);
  EXPECT_EQ(ndi::parse_tx("FF", ndi::kTransforms).error(), ReplyFault::too_many_handles);
}

TEST(TxReply, PassesOverStrayMarkers) {
  const auto reply = ndi::parse_tx(
      "0301\n02\n03DISABLED\n030-000871+012492-157709-003825+010392-160948-005537+015317-1626120080", 0x1000);
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->handles[0].has_transform);
  EXPECT_NE(reply->handles[0].status, HandleStatus::missing) << "nobody asked";
  EXPECT_EQ(reply->system_status, 0x0080);
}

}  // namespace
}  // namespace orcart::testing
