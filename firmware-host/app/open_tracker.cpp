// One branch a kind.
#include "firmware-host/app/open_tracker.hpp"

#include "board/linux/tcp_link.hpp"
#include "board/linux/tty_link.hpp"
#include "board/linux/usb/libusb_bus.hpp"
#include "board/linux/usb/usb_link.hpp"
#include "firmware-host/tracker/replay_byte_link.hpp"

namespace orcart {
namespace {

template <class Link>
Result<std::unique_ptr<ByteLink>> as_byte_link(Result<std::unique_ptr<Link>> link) {
  if (!link) return tl::unexpected(link.error());
  return std::unique_ptr<ByteLink>(std::move(*link));
}

}  // namespace

Result<std::unique_ptr<ByteLink>> open_tracker(const TrackerConfig& tracker, Clock& clock) {
  switch (tracker.kind) {
    case TrackerKind::simulated:
      break;
    case TrackerKind::usb:
      return as_byte_link(UsbLink::open(std::make_unique<LibusbBus>(),
                                        {.serial = tracker.usb_serial, .port_path = tracker.usb_port}));
    case TrackerKind::tty:
      return as_byte_link(TtyLink::open(tracker.device.string()));
    case TrackerKind::tcp:
      return as_byte_link(TcpLink::open({.host = tracker.host, .port = tracker.port}));
    case TrackerKind::replay: {
      auto dialogue = ndi::read_dialogue(tracker.dialogue);
      if (!dialogue) return tl::unexpected(dialogue.error());
      return std::make_unique<ReplayByteLink>(*dialogue, clock);
    }
  }
  return std::unique_ptr<ByteLink>{};
}

}  // namespace orcart
