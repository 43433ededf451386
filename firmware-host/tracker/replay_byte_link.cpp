// Looks up what the recorded device said to a command.
#include "firmware-host/tracker/replay_byte_link.hpp"

#include <algorithm>
#include <cstring>

#include "firmware-host/tracker/ndi/hex.hpp"

namespace orcart {
namespace {

std::string_view name_of(std::string_view command) {
  return command.substr(0, command.find_first_of(": \r"));
}

bool is_tracking(std::string_view command) {
  const std::string_view name = name_of(command);
  return name == "BX" || name == "TX" || name == "BX2";
}

/// What a device is asked of itself: OKAY would be no answer.
bool is_question(std::string_view command) {
  const std::string_view name = name_of(command);
  return name == "APIREV" || name == "VER" || name == "GET" || name == "GETINFO";
}

/// Whether TX or BX asks for transforms and nothing else that changes the reply's form.
bool asks_for_transforms(std::string_view command) {
  constexpr std::uint32_t kForm = 0x300F;
  const auto options = command.size() >= 7 ? ndi::parse_hex(command.substr(3, 4)) : std::nullopt;
  return options && (*options & kForm) == 0x0001;
}

bool answers(std::string_view recorded, std::string_view asked) {
  if (recorded == asked) return true;
  if (name_of(recorded) != name_of(asked)) return false;
  if (name_of(asked) == "BX2") return true;
  return !is_tracking(asked) || (asks_for_transforms(recorded) && asks_for_transforms(asked));
}

}  // namespace

ReplayByteLink::ReplayByteLink(const ndi::Dialogue& dialogue, Clock& clock, Nanos reply_delay)
    : clock_(clock), delay_(reply_delay) {
  for (std::size_t i = 0; i + 1 < dialogue.size(); ++i) {
    const bool turn =
        dialogue[i].speaker == ndi::Speaker::host && dialogue[i + 1].speaker == ndi::Speaker::device;
    if (turn) turns_.push_back({dialogue[i].bytes, dialogue[i + 1].bytes});
  }
}

int ReplayByteLink::find(std::string_view command, std::size_t from) const noexcept {
  int same_name = -1;
  for (std::size_t i = from; i < turns_.size(); ++i) {
    if (turns_[i].command == command) return static_cast<int>(i);
    if (same_name < 0 && answers(turns_[i].command, command)) same_name = static_cast<int>(i);
  }
  return same_name;
}

void ReplayByteLink::answer(std::string_view reply) noexcept {
  reply_ = reply;
  arrives_at_ = clock_.now() + delay_;
}

Result<void, PortFault> ReplayByteLink::write(std::span<const std::byte> bytes) noexcept {
  const std::string_view command{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  const bool tracking = is_tracking(command);
  std::size_t& place = tracking ? next_tracking_ : next_set_up_;
  int turn = find(command, place);
  if (turn < 0 && !tracking) turn = find(command, 0);
  if (turn >= 0) {
    place = static_cast<std::size_t>(turn) + 1;
    answer(turns_[static_cast<std::size_t>(turn)].reply);
  } else if (tracking && find(command, 0) < 0) {
    answer("ERROR016BC2\r");
  } else if (tracking) {
    finished_ = true;
  } else if (is_question(command)) {
    answer("ERROR016BC2\r");
  } else {
    answer("OKAYA896\r");
  }
  return {};
}

Result<std::size_t, PortFault> ReplayByteLink::read(std::span<std::byte> into) noexcept {
  if (reply_.empty() || clock_.now() < arrives_at_) return std::size_t{0};
  const std::size_t count = std::min(into.size(), reply_.size());
  std::memcpy(into.data(), reply_.data(), count);
  reply_.remove_prefix(count);
  return count;
}

Result<void, PortFault> ReplayByteLink::send_break() noexcept {
  answer("RESETBE6F\r");
  return {};
}

void ReplayByteLink::wait(Instant deadline) noexcept {
  clock_.sleep_until(std::max(clock_.now(), std::min(deadline, next_event())));
}

}  // namespace orcart
