// Takes a fault's text apart from its end.
#include "tools/emulate/fault_argument.hpp"

#include <charconv>
#include <optional>
#include <string>

namespace orcart {
namespace {

constexpr std::string_view kKinds =
    "silence, late, truncated, garbage, bad-crc, wrong-handle, frozen-frame, infrared, disabled, unplugged, "
    "reset, bump, alert, cut";

/// Cuts off what follows the last `mark`; nothing where it is not there.
std::optional<std::string_view> cut_off(std::string_view& text, char mark) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view tail = text.substr(at + 1);
  text = text.substr(0, at);
  return tail;
}

template <class Number>
bool read_number(std::string_view text, Number& into) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), into);
  return error == std::errc{} && end == text.data() + text.size() && into >= 0;
}

bool read_times(std::string_view text, Instant start, NdiFaultWindow& window) {
  const std::size_t dash = text.find('-');
  double from_s = 0;
  double until_s = 0;
  if (!read_number(text.substr(0, dash), from_s)) return false;
  window.from = start + from_seconds(from_s);
  if (dash == std::string_view::npos) return true;
  if (!read_number(text.substr(dash + 1), until_s) || until_s <= from_s) return false;
  window.until = start + from_seconds(until_s);
  return true;
}

}  // namespace

Result<NdiFaultWindow> parse_fault(std::string_view text, Instant start) {
  NdiFaultWindow window{.from = start};
  std::string_view kind = text;
  const auto times_and_share = cut_off(kind, '@');
  std::string_view times = times_and_share.value_or("0");
  const auto every = cut_off(times_and_share ? times : kind, '/');
  const auto amount = cut_off(kind, ':');
  const auto fault = ndi_fault_named(kind);
  bool good = fault.has_value() && read_times(times, start, window);
  if (every) good = good && read_number(*every, window.every) && window.every > 0;
  if (amount) good = good && read_number(*amount, window.amount);
  if (!good) {
    return fail("fault \"" + std::string(text) +
                "\" is not understood; KIND[:AMOUNT][@FROM[-UNTIL]][/EVERY] would be accepted, KIND one of " +
                std::string(kKinds));
  }
  window.fault = *fault;
  return window;
}

}  // namespace orcart
