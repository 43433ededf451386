// One key's events become edges.
#include "board/linux/pedal/keyboard_pedal.hpp"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>

#include "board/linux/byte_stream.hpp"
#include "board/linux/input_device.hpp"

namespace orcart {
namespace {

struct NamedKey {
  std::string_view name;
  std::uint16_t code;
};
constexpr NamedKey kKeys[] = {{"a", KEY_A},
                              {"b", KEY_B},
                              {"c", KEY_C},
                              {"d", KEY_D},
                              {"e", KEY_E},
                              {"f", KEY_F},
                              {"g", KEY_G},
                              {"h", KEY_H},
                              {"i", KEY_I},
                              {"j", KEY_J},
                              {"k", KEY_K},
                              {"l", KEY_L},
                              {"m", KEY_M},
                              {"n", KEY_N},
                              {"o", KEY_O},
                              {"p", KEY_P},
                              {"q", KEY_Q},
                              {"r", KEY_R},
                              {"s", KEY_S},
                              {"t", KEY_T},
                              {"u", KEY_U},
                              {"v", KEY_V},
                              {"w", KEY_W},
                              {"x", KEY_X},
                              {"y", KEY_Y},
                              {"z", KEY_Z},
                              {"0", KEY_0},
                              {"1", KEY_1},
                              {"2", KEY_2},
                              {"3", KEY_3},
                              {"4", KEY_4},
                              {"5", KEY_5},
                              {"6", KEY_6},
                              {"7", KEY_7},
                              {"8", KEY_8},
                              {"9", KEY_9},
                              {"f1", KEY_F1},
                              {"f2", KEY_F2},
                              {"f3", KEY_F3},
                              {"f4", KEY_F4},
                              {"f5", KEY_F5},
                              {"f6", KEY_F6},
                              {"f7", KEY_F7},
                              {"f8", KEY_F8},
                              {"f9", KEY_F9},
                              {"f10", KEY_F10},
                              {"f11", KEY_F11},
                              {"f12", KEY_F12},
                              {"f13", KEY_F13},
                              {"f14", KEY_F14},
                              {"f15", KEY_F15},
                              {"f16", KEY_F16},
                              {"f17", KEY_F17},
                              {"f18", KEY_F18},
                              {"f19", KEY_F19},
                              {"f20", KEY_F20},
                              {"f21", KEY_F21},
                              {"f22", KEY_F22},
                              {"f23", KEY_F23},
                              {"f24", KEY_F24},
                              {"space", KEY_SPACE},
                              {"enter", KEY_ENTER},
                              {"tab", KEY_TAB},
                              {"escape", KEY_ESC},
                              {"left", KEY_LEFT},
                              {"right", KEY_RIGHT},
                              {"up", KEY_UP},
                              {"down", KEY_DOWN},
                              {"pageup", KEY_PAGEUP},
                              {"pagedown", KEY_PAGEDOWN},
                              {"leftbutton", BTN_LEFT},
                              {"rightbutton", BTN_RIGHT}};

using KeyBits = std::array<std::uint8_t, KEY_CNT / 8 + 1>;

bool has(const KeyBits& bits, std::uint16_t key) {
  return (bits[key / 8] >> (key % 8) & 1) != 0;
}

}  // namespace

std::optional<std::uint16_t> key_code_of(const std::string& key) {
  for (const NamedKey& named : kKeys)
    if (named.name == key) return named.code;
  std::uint16_t code = 0;
  const char* end = key.data() + key.size();
  const auto read = std::from_chars(key.data(), end, code);
  if (key.size() < 2 || read.ec != std::errc{} || read.ptr != end || code >= KEY_CNT) return std::nullopt;
  return code;
}

std::string known_keys() {
  std::string names;
  for (const NamedKey& named : kKeys) names += std::string(named.name) + ", ";
  return names + "or a key code from 10 on";
}

Result<std::unique_ptr<KeyboardPedal>> KeyboardPedal::open(const KeyboardWish& wish, Clock& clock,
                                                           DeviceCalls& calls) {
  const auto key = key_code_of(wish.key);
  if (!key) return fail("pedal key \"" + wish.key + "\" is unknown; " + known_keys() + " would be accepted");
  std::unique_ptr<KeyboardPedal> pedal(new KeyboardPedal(wish, *key, clock, calls));
  if (auto opened = pedal->open_device(); !opened) return tl::unexpected(opened.error());
  return pedal;
}

Result<void> KeyboardPedal::open_device() {
  const auto refused = [&](int error) { return fail(input_trouble("pedal", wish_.device, error)); };
  auto device = open_input(calls_, wish_.device);
  if (!device) return refused(device.error());
  KeyBits keys{};
  if (const int answer = device->control(EVIOCGBIT(EV_KEY, keys.size()), keys.data()); answer < 0)
    return refused(answer);
  if (!has(keys, key_))
    return fail("pedal " + wish_.device + " has no key \"" + wish_.key +
                "\"; one of its keys would be accepted");
  if (const int answer = take_over(*device); answer < 0) return refused(answer);
  device_ = std::move(*device);
  ledger_.found_at(is_down() ? EdgeKind::pressed : EdgeKind::released);
  return {};
}

bool KeyboardPedal::is_down() const noexcept {
  KeyBits down{};
  return device_.control(EVIOCGKEY(down.size()), down.data()) >= 0 && has(down, key_);
}

void KeyboardPedal::lose_device() noexcept {
  device_.reset();
  ledger_.lose();
  retry_at_ = clock_.now() + kRetry;
}

void KeyboardPedal::wait(Instant deadline) noexcept {
  if (count_ > 0) return;
  do {  // bound: a round every kRetry until the deadline, and one for each wake-up
    if (device_.valid()) {
      const int events = calls_.wait(device_.fd(), POLLIN, deadline);
      if (events != 0) return;
    } else {
      clock_.sleep_until(std::min(deadline, retry_at_));
      if (clock_.now() < retry_at_) continue;
      if (!open_device()) retry_at_ = clock_.now() + kRetry;
    }
  } while (clock_.now() < deadline);
}

// A repeated key (value 2) is no edge. SYN_DROPPED: the kernel's queue overflowed, and the key's state is
// asked for.
Result<void, PortFault> KeyboardPedal::read_more() noexcept {
  std::array<input_event, 16> events{};
  const auto count = read_events(device_, events);
  if (!count) {
    if (count.error() == PortFault::disconnected) lose_device();
    return tl::unexpected(count.error());
  }
  const auto keep = [&](EdgeKind kind, Instant at) {
    edges_[count_++] = ledger_.accept({.kind = kind, .at = at, .number = std::nullopt});
  };
  first_ = count_ = 0;
  for (std::size_t i = 0; i < *count; ++i) {
    const input_event& event = events[i];
    const Instant at = stamp_of(event);
    if (event.type == EV_SYN && event.code == SYN_DROPPED) {
      ledger_.lose();
      const EdgeKind now = is_down() ? EdgeKind::pressed : EdgeKind::released;
      if (now != ledger_.level()) keep(now, at);
    } else if (event.type == EV_KEY && event.code == key_ && event.value != 2) {
      keep(event.value == 1 ? EdgeKind::pressed : EdgeKind::released, at);
    }
  }
  return {};
}

Result<PedalEdge, PortFault> KeyboardPedal::take_edge() noexcept {
  for (int i = 0; i < 64 && count_ == 0; ++i) {  // events of other keys make empty rounds
    if (!device_.valid()) return tl::unexpected(PortFault::disconnected);
    if (auto more = read_more(); !more) return tl::unexpected(more.error());
  }
  if (count_ == 0) return tl::unexpected(PortFault::nothing_yet);
  --count_;
  return edges_[first_++];
}

std::vector<KeyboardFacts> keyboards() {
  std::vector<KeyboardFacts> all;
  for (const std::string& node : input_nodes()) {
    KeyboardFacts facts{.path = node};
    const auto device = open_input(system_calls(), node);
    if (!device) {
      const PortFault fault = port_fault_of(-device.error());
      facts.trouble = node + ": " + std::string(word_for(fault)) + input_remedy("pedal", fault);
    } else {
      KeyBits keys{};
      (void)device->control(EVIOCGBIT(EV_KEY, keys.size()), keys.data());
      if (std::ranges::none_of(keys, [](std::uint8_t byte) { return byte != 0; })) continue;
      facts.name = input_name(*device);
    }
    all.push_back(std::move(facts));
  }
  return all;
}

}  // namespace orcart
