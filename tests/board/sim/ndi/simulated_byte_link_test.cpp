// The simulated line keeps the ByteLink contract, and garbles what is said at another rate.
#include "board/sim/ndi/simulated_byte_link.hpp"

#include "tests/board/ports/byte_link_contract.hpp"
#include "tests/board/sim/ndi/emulated_session.hpp"

namespace orcart::testing {

class SimulatedRig final : public ByteLinkRig {
 public:
  Clock& clock() override { return clock_; }
  ByteLink& link() override { return link_; }
  void cut() override { link_.unplug(); }
  bool mend() override {
    link_.plug_in();
    return true;
  }

 private:
  StillTool motion_;
  SimulatedClock clock_;
  NdiEmulator device_{{}, motion_};
  SimulatedByteLink link_{device_, clock_};
};

INSTANTIATE_TYPED_TEST_SUITE_P(Simulated, ByteLinkContract, SimulatedRig);

namespace {

TEST(SimulatedByteLink, UnderstandsNothingAtAnotherRate) {
  SimulatedRig rig;
  ASSERT_TRUE(rig.link().set_line({.baud = 57600}));
  constexpr std::string_view kQuestion = "INIT:E3A5\r";
  ASSERT_TRUE(rig.link().write(std::as_bytes(std::span{kQuestion.data(), kQuestion.size()})));
  EXPECT_EQ(rig.link().next_event(), Instant::max()) << "the device heard nothing it could answer";
}

}  // namespace
}  // namespace orcart::testing
