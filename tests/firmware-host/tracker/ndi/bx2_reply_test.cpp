// BX2 replies: frames, tools, alerts, what is passed over, and every way in which one may end too early.
#include <gtest/gtest.h>

#include <bit>

#include "firmware-host/tracker/ndi/tracking_reply.hpp"
#include "firmware-host/tracker/ndi/words.hpp"
#include "tests/firmware-host/tracker/ndi/wire_samples.hpp"

namespace orcart::testing {
namespace {

using ndi::HandleStatus;

std::string number(std::uint64_t value, int size) {
  std::string bytes;
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFFu);
  return bytes;
}

std::string component(unsigned type, unsigned items, const std::string& content) {
  return number(type, 2) + number(content.size() + 12, 4) + number(0, 2) + number(items, 4) + content;
}

std::string tool(unsigned handle, unsigned status) {
  std::string bytes = number(handle, 2) + number(status, 2);
  if ((status & 0x100u) != 0) return bytes;
  for (const float part : {1.0F, 0.0F, 0.0F, 0.0F, 10.0F, 20.0F, -1500.0F, 0.25F})
    bytes += number(std::bit_cast<std::uint32_t>(part), 4);
  return bytes;
}

/// A frame with so many components.
std::string frame(unsigned index, unsigned components, const std::string& content) {
  return number(2, 1) + number(7, 1) + number(0, 2) + number(index, 4) + number(0, 8) + number(1, 2) +
         number(components, 2) + content;
}

std::string reply_of(unsigned components, const std::string& content) {
  return number(1, 2) + number(components, 2) + content;
}

TEST(Bx2Reply, TellsEachToolWithItsFrame) {
  const std::string tools =
      tool(1, 0) + tool(2, 0x11F) + tool(3, 0x120) + tool(4, 0x121) + tool(5, 9) + tool(6, 3);
  const std::string body = reply_of(1, component(1, 1, frame(0x12345, 1, component(2, 6, tools))));
  const auto reply = ndi::parse_bx2(bytes_of(body));
  ASSERT_TRUE(reply);
  ASSERT_EQ(reply->count, 6u);
  EXPECT_TRUE(reply->has_frame);
  const auto& handles = reply->handles;
  EXPECT_EQ(handles[0].status, HandleStatus::valid);
  EXPECT_EQ(handles[0].frame, 0x12345u);
  EXPECT_EQ(handles[0].port_status, ndi::kPortReady);
  EXPECT_EQ(handles[0].translation_mm, (std::array<float, 3>{10, 20, -1500}));
  EXPECT_EQ(handles[0].error_mm, 0.25F);
  EXPECT_EQ(handles[1].status, HandleStatus::missing);
  EXPECT_EQ(ndi::tool_status_word(handles[1].tool_code), "not seen");
  EXPECT_EQ(handles[2].status, HandleStatus::disabled);
  EXPECT_EQ(ndi::disabled_reason(handles[2].port_status), "the port is not enabled");
  EXPECT_EQ(handles[3].status, HandleStatus::disabled);
  EXPECT_EQ(ndi::port_status_words(handles[3].port_status).substr(0, 19), "no tool in the port");
  EXPECT_EQ(ndi::port_status_words(handles[4].port_status), "outside the measurement volume");
  EXPECT_NE(handles[5].port_status & ndi::kPartlyInVolume, 0u);
}

TEST(Bx2Reply, KeepsTheFramesOfTwoKindsOfToolsApart) {
  const std::string frames =
      frame(10, 1, component(2, 1, tool(1, 0))) + frame(11, 1, component(2, 1, tool(2, 0)));
  const auto reply = ndi::parse_bx2(bytes_of(reply_of(1, component(1, 2, frames))));
  ASSERT_TRUE(reply);
  ASSERT_EQ(reply->count, 2u);
  EXPECT_EQ(reply->handles[0].frame, 10u);
  EXPECT_EQ(reply->handles[1].frame, 11u);
}

TEST(Bx2Reply, ThatHasNothingNewHasNoFrame) {
  const auto reply = ndi::parse_bx2(bytes_of(reply_of(0, "")));
  ASSERT_TRUE(reply);
  EXPECT_FALSE(reply->has_frame);
  EXPECT_EQ(reply->count, 0u);
}

TEST(Bx2Reply, TellsThatTheSensorWasBumped) {
  const std::string alerts = number(1, 1) + number(0, 1) + number(2, 2) + number(0, 1) + number(0, 1) +
                             number(4, 2) + number(2, 1) + number(0, 1) + number(2, 2) + number(9, 1) +
                             number(0, 1) + number(1, 2);
  const auto reply =
      ndi::parse_bx2(bytes_of(reply_of(1, component(1, 1, frame(1, 1, component(0x12, 4, alerts))))));
  ASSERT_TRUE(reply);
  EXPECT_TRUE(reply->alerts.bumped());
  EXPECT_EQ(ndi::alert_words(reply->alerts), "sensor voltage fault, the sensor was bumped, tool unplugged");
}

TEST(Bx2Reply, PassesOverWhatItDoesNotKnow) {
  const std::string unknown = component(0x11, 3, "scaled positions on the sensors");
  const std::string body = reply_of(
      2, unknown + component(1, 1, frame(5, 2, component(3, 1, "markers") + component(2, 1, tool(1, 0)))));
  const auto reply = ndi::parse_bx2(bytes_of(body));
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->count, 1u);
}

TEST(Bx2Reply, IsRefusedWhereverItIsCutShortOrGoesOn) {
  const std::string body =
      reply_of(1, component(1, 1, frame(1, 1, component(2, 2, tool(1, 0) + tool(2, 0x11F)))));
  for (std::size_t size = 0; size < body.size(); ++size)
    EXPECT_FALSE(ndi::parse_bx2(bytes_of(body).first(size))) << size;
  EXPECT_FALSE(ndi::parse_bx2(bytes_of(body + "x")));
  EXPECT_FALSE(ndi::parse_bx2(bytes_of(reply_of(1, number(1, 2) + number(3, 4) + number(0, 6)))))
      << "size below 12";
  std::string many;
  for (unsigned i = 0; i < 25; ++i) many += tool(i + 1, 0x11F);
  EXPECT_FALSE(ndi::parse_bx2(bytes_of(reply_of(1, component(1, 1, frame(1, 1, component(2, 25, many)))))));
  EXPECT_FALSE(ndi::parse_bx2(
      bytes_of(reply_of(1, component(1, 1, frame(1, 1, component(2, 0xFFFFFFFF, tool(1, 0))))))));
}

TEST(SystemAlerts, AreTheSameAsParameterAndAsComponents) {
  const auto alerts = ndi::alerts_from_parameter(0x0020'0008);
  EXPECT_TRUE(alerts.bumped());
  EXPECT_EQ(ndi::alert_words(alerts), "sensor voltage fault, the sensor was bumped");
  EXPECT_EQ(ndi::parameter_from_alerts(alerts), 0x0020'0008u);
  EXPECT_EQ(ndi::alert_words({}), "");
  EXPECT_EQ(ndi::alert_words({.alerts = 1u << 30}), "condition 30");
}

TEST(Words, TellAllThatAPortAndASystemSay) {
  EXPECT_EQ(ndi::port_status_words(0x31), "ready");
  EXPECT_EQ(ndi::port_status_words(0x01), "the port is not initialised");
  EXPECT_EQ(ndi::port_status_words(0x31 | 0x02 | 0x80),
            "switch 1 pressed, partly outside the measurement volume");
  EXPECT_EQ(ndi::port_status_words(0x131), "sensor broken, or a limit of the algorithm");
  EXPECT_EQ(ndi::system_status_words(0x0102), "too much environmental infra-red, alerts are pending");
}

}  // namespace
}  // namespace orcart::testing
