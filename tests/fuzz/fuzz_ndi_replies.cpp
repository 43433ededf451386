// Any bytes as a reply: framing, then every parser of what a good frame may hold.
#include <cstddef>
#include <cstdint>

#include "firmware-host/tracker/ndi/framing.hpp"
#include "firmware-host/tracker/ndi/port_reply.hpp"
#include "firmware-host/tracker/ndi/tracking_reply.hpp"
#include "firmware-host/tracker/ndi/words.hpp"

namespace {

using namespace orcart::ndi;

/// A frame must lie within what was given.
void check(const ReplyFrame& frame, std::size_t size) {
  if (frame.skipped > size || frame.consumed > size || frame.payload.size() > size) __builtin_trap();
}

void parse_text(std::string_view text, std::uint16_t options) {
  (void)parse_tx(text, options);
  (void)parse_port_handles(text);
  (void)parse_port_description(text, options);
  (void)parse_port_location(text);
  (void)parse_new_handle(text);
  if (const auto code = error_code(text)) (void)error_word(*code);
}

void parse_body(std::span<const std::byte> body, std::uint16_t options) {
  if (const auto reply = parse_bx(body, options)) (void)system_status_words(reply->system_status);
  if (const auto reply = parse_bx2(body)) (void)alert_words(reply->alerts);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto options = static_cast<std::uint16_t>(data[0] | data[1] << 8);
  const auto bytes = std::as_bytes(std::span{data + 2, size - 2});
  check(find_ascii_reply(bytes), bytes.size());
  check(find_binary_reply(bytes), bytes.size());
  // A fuzzer never guesses a CRC: the parsers get the bytes as if they had passed it.
  parse_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, options);
  parse_body(bytes, options);
  return 0;
}
