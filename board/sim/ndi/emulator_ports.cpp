// The emulated tracker's commands about port handles and tools.
#include <algorithm>

#include "board/sim/ndi/ndi_emulator.hpp"

namespace orcart {
namespace {

// What PHINF can be asked for; the options add up, the replies follow each other.
constexpr std::uint32_t kBasics = 0x01;
constexpr std::uint32_t kCurrentTest = 0x02;
constexpr std::uint32_t kPartNumber = 0x04;
constexpr std::uint32_t kAccessories = 0x08;
constexpr std::uint32_t kMarkerType = 0x10;
constexpr std::uint32_t kLocation = 0x20;
constexpr std::uint32_t kGpio = 0x40;

constexpr std::size_t kRomBlockBytes = 64;
constexpr std::uint16_t kPortUnoccupied = 0x0080;

void put_basics(const EmulatedPort& port, WireText& reply) {
  reply.hex(port.byte_at(15), 2);  // main type
  reply.text("0000");              // switches, LEDs, reserved
  reply.hex(port.byte_at(16), 2);  // sub-type
  reply.padded(port.text_at(580, 12), 12);
  reply.text("000");
  reply.hex(port.number_at(20), 8);
  reply.hex(port.status(), 2);
}

/// Device, kind of system, wired or wireless, port, channel.
void put_location(const EmulatedPort& port, std::size_t handle, const EmulatedModel& model, WireText& reply) {
  reply.text("P0-00001");
  reply.text({&model.system_letter, 1});
  reply.text(port.socket() > 0 ? "0" : "1");
  reply.hex(static_cast<std::uint32_t>(port.socket() > 0 ? port.socket() : static_cast<int>(handle)), 2);
  reply.text("00");
}

/// Which ports PHSR lists for each of its five questions.
bool is_listed(const EmulatedPort& port, std::uint32_t question) {
  if (!port.allocated()) return false;
  switch (question) {
    case 0:
      return true;
    case 1:
      return !port.occupied();
    case 2:
      return port.occupied() && !port.initialised();
    case 3:
      return port.initialised() && !port.enabled();
    default:
      return port.enabled();
  }
}

}  // namespace

EmulatedPort* NdiEmulator::port_of(std::string_view handle) noexcept {
  const auto number = parse_hex_field(handle);
  if (handle.size() != 2 || !number || *number == 0 || *number > kMaxPorts) return nullptr;
  EmulatedPort& port = ports_[*number - 1];
  return port.allocated() ? &port : nullptr;
}

void NdiEmulator::suffer_tool_faults(Instant now) noexcept {
  for (std::size_t i = 0; i < kMaxPorts; ++i) {
    const auto tool = static_cast<std::int64_t>(i);
    if (ports_[i].enabled() && faults_.hits_tool(NdiFault::disabled, now, tool)) ports_[i].lose_enable();
    if (ports_[i].occupied() && faults_.hits_tool(NdiFault::unplugged, now, tool)) {
      ports_[i].unplug();
      port_events_ |= kPortUnoccupied;
    }
  }
}

bool NdiEmulator::plug_in(std::span<const std::byte> definition) noexcept {
  const auto free =
      std::find_if(plugged_in_.begin(), plugged_in_.end(), [](const auto& port) { return !port.occupied(); });
  if (free == plugged_in_.end()) return false;
  free->allocate();
  free->plug_into(static_cast<int>(free - plugged_in_.begin()) + 1);
  return free->write(0, definition) == NdiError::none;
}

NdiError NdiEmulator::on_phrq(std::string_view arguments, const Moment&) noexcept {
  if (arguments.size() != 14) return NdiError::wrong_parameters;
  const auto free =
      std::find_if(ports_.begin(), ports_.end(), [](const auto& port) { return !port.allocated(); });
  if (free == ports_.end()) return NdiError::handles_full;
  free->allocate();
  reply_.hex(static_cast<std::uint32_t>(free - ports_.begin()) + 1, 2);
  return NdiError::none;
}

NdiError NdiEmulator::on_pvwr(std::string_view arguments, const Moment&) noexcept {
  if (arguments.size() != 6 + 2 * kRomBlockBytes) return NdiError::wrong_parameters;
  EmulatedPort* port = port_of(arguments.substr(0, 2));
  if (port == nullptr) return NdiError::no_such_handle;
  const auto address = parse_hex_field(arguments.substr(2, 4));
  std::array<std::byte, kRomBlockBytes> block{};
  for (std::size_t i = 0; i < kRomBlockBytes; ++i) {
    const auto byte = parse_hex_field(arguments.substr(6 + 2 * i, 2));
    if (!byte) return NdiError::out_of_range;
    block[i] = static_cast<std::byte>(*byte);
  }
  if (!address) return NdiError::out_of_range;
  const NdiError error = port->write(*address, block);
  return error != NdiError::none ? error : okay();
}

NdiError NdiEmulator::on_phsr(std::string_view arguments, const Moment&) noexcept {
  const auto question = parse_hex_field(arguments.empty() ? "00" : arguments);
  if (!question || *question > 4) return NdiError::out_of_range;
  port_events_ = 0;
  const auto listed = [&](const EmulatedPort& port) { return is_listed(port, *question); };
  reply_.hex(static_cast<std::uint32_t>(std::count_if(ports_.begin(), ports_.end(), listed)), 2);
  for (std::size_t i = 0; i < kMaxPorts; ++i) {
    if (!listed(ports_[i])) continue;
    reply_.hex(static_cast<std::uint32_t>(i) + 1, 2);
    reply_.hex(ports_[i].status(), 3);
  }
  return NdiError::none;
}

NdiError NdiEmulator::on_phinf(std::string_view arguments, const Moment&) noexcept {
  if (arguments.size() != 2 && arguments.size() != 6) return NdiError::wrong_parameters;
  const EmulatedPort* port = port_of(arguments.substr(0, 2));
  if (port == nullptr) return NdiError::no_such_handle;
  const auto options = arguments.size() == 2 ? std::optional{kBasics} : parse_hex_field(arguments.substr(2));
  if (!options) return NdiError::out_of_range;
  if (!port->occupied()) {
    reply_.text("UNOCCUPIED");
    return NdiError::none;
  }
  if ((*options & kBasics) != 0) put_basics(*port, reply_);
  if ((*options & kCurrentTest) != 0) reply_.text("00000000");
  if ((*options & kPartNumber) != 0) reply_.padded(port->text_at(592, 20), 20);
  if ((*options & kAccessories) != 0) reply_.text("00");
  if ((*options & kMarkerType) != 0) reply_.hex(port->byte_at(655), 2);
  if ((*options & kLocation) != 0)
    put_location(*port, static_cast<std::size_t>(port - ports_.data()) + 1, model_, reply_);
  if ((*options & kGpio) != 0) reply_.text("00");
  return NdiError::none;
}

NdiError NdiEmulator::on_pinit(std::string_view arguments, const Moment&) noexcept {
  EmulatedPort* port = port_of(arguments);
  const NdiError error = port == nullptr ? NdiError::no_such_handle : port->initialise();
  return error != NdiError::none ? error : okay();
}

NdiError NdiEmulator::on_pena(std::string_view arguments, const Moment&) noexcept {
  if (arguments.size() != 3) return NdiError::wrong_parameters;
  EmulatedPort* port = port_of(arguments.substr(0, 2));
  const NdiError error = port == nullptr ? NdiError::no_such_handle : port->enable(arguments[2]);
  return error != NdiError::none ? error : okay();
}

NdiError NdiEmulator::on_pdis(std::string_view arguments, const Moment&) noexcept {
  EmulatedPort* port = port_of(arguments);
  const NdiError error = port == nullptr ? NdiError::no_such_handle : port->disable();
  return error != NdiError::none ? error : okay();
}

NdiError NdiEmulator::on_phf(std::string_view arguments, const Moment&) noexcept {
  EmulatedPort* port = port_of(arguments);
  if (port == nullptr) return NdiError::no_such_handle;
  port->release();
  return okay();
}

}  // namespace orcart
