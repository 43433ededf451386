// Reads the replies about port handles.
#include "firmware-host/tracker/ndi/port_reply.hpp"

#include "firmware-host/tracker/ndi/command.hpp"
#include "firmware-host/tracker/ndi/text_cursor.hpp"

namespace orcart::ndi {
namespace {

std::string_view without_padding(std::string_view text) noexcept {
  const std::size_t end = text.find_last_not_of(' ');
  return text.substr(0, end == std::string_view::npos ? 0 : end + 1);
}

}  // namespace

std::optional<PortLocation> parse_port_location(std::string_view text) noexcept {
  TextCursor cursor(text);
  cursor.take(9);  // device, kind of system
  const std::string_view kind = cursor.take(1);
  PortLocation location{.wired = kind == "0"};
  location.port = static_cast<int>(cursor.hex(2));
  location.channel = static_cast<int>(cursor.hex(2));
  if (!cursor.ok() || cursor.left() != 0) return std::nullopt;
  return location;
}

std::optional<std::uint8_t> parse_new_handle(std::string_view text) noexcept {
  if (text.size() != 2) return std::nullopt;
  const auto handle = parse_hex(text);
  return handle ? std::optional{static_cast<std::uint8_t>(*handle)} : std::nullopt;
}

Result<PortHandles, ReplyFault> parse_port_handles(std::string_view text) noexcept {
  TextCursor cursor(text);
  PortHandles handles;
  handles.count = cursor.hex(2);
  if (handles.count > PortHandles::kMax) return tl::unexpected(ReplyFault::too_many_handles);
  for (std::size_t i = 0; i < handles.count; ++i) {
    handles.list[i].handle = static_cast<std::uint8_t>(cursor.hex(2));
    handles.list[i].status = static_cast<std::uint16_t>(cursor.hex(3));
  }
  if (!cursor.ok()) return tl::unexpected(ReplyFault::bad_number);
  if (cursor.left() != 0) return tl::unexpected(ReplyFault::trailing);
  return handles;
}

Result<PortDescription, ReplyFault> parse_port_description(std::string_view text,
                                                           std::uint16_t options) noexcept {
  PortDescription port;
  TextCursor cursor(text);
  if (cursor.take_word("UNOCCUPIED")) return port;
  port.occupied = true;
  port.main_type = static_cast<std::uint8_t>(cursor.hex(2));
  cursor.take(6);  // switches, LEDs, two reserved, sub-type
  port.manufacturer = without_padding(cursor.take(12));
  port.revision = cursor.take(3);
  port.serial_number = cursor.take(8);
  port.status = static_cast<std::uint8_t>(cursor.hex(2));
  if ((options & kPartNumber) != 0) port.part_number = without_padding(cursor.take(20));
  if (!cursor.ok()) return tl::unexpected(ReplyFault::truncated);
  return port;
}

}  // namespace orcart::ndi
