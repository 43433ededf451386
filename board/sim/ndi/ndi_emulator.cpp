// The emulated tracker's front door: bytes to commands, commands to handlers, replies to the wire, faults in
// between.
#include "board/sim/ndi/ndi_emulator.hpp"

#include <algorithm>

#include "realtime/base/crc16.hpp"

namespace orcart {
namespace {

/// How long after its answer to COMM the device changes the line rate; hosts wait 100 ms.
constexpr Nanos kSwitchAfter = 5ms;

constexpr char upper(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

}  // namespace

NdiEmulator::NdiEmulator(const NdiEmulatorSettings& settings, const ToolMotion& motion)
    : settings_(settings),
      motion_(motion),
      frame_rate_hz_(settings.frame_rate_hz),
      clock_(settings.on_at, settings.frame_phase, settings.frame_rate_hz, settings.clock_drift_ppm),
      model_(description_of(settings.model)),
      parameters_(model_, settings.frame_rate_hz) {}

std::span<const NdiEmulator::Verb> NdiEmulator::verbs() noexcept {
  using E = NdiEmulator;
  static constexpr auto kVerbs = std::to_array<Verb>({
      {"INIT", Mode::any, &E::on_init},
      {"COMM", Mode::any, &E::on_comm},
      {"VER", Mode::any, &E::on_ver},
      {"APIREV", Mode::any, &E::on_apirev},
      {"SFLIST", Mode::any, &E::on_sflist},
      {"SSTAT", Mode::any, &E::on_sstat},
      {"GET", Mode::any, &E::on_get},
      {"GETINFO", Mode::any, &E::on_getinfo},
      {"SET", Mode::any, &E::on_set},
      {"BEEP", Mode::any, &E::on_beep},
      {"ECHO", Mode::any, &E::on_echo},
      {"RESET", Mode::any, &E::on_reset},
      {"LED", Mode::set_up, &E::on_accepted},
      {"PSOUT", Mode::set_up, &E::on_accepted},
      {"IRATE", Mode::not_tracking, &E::on_irate},
      {"VSEL", Mode::not_tracking, &E::on_accepted},
      {"SENSEL", Mode::not_tracking, &E::on_accepted},
      {"DSTART", Mode::not_tracking, &E::on_accepted},
      {"DSTOP", Mode::not_tracking, &E::on_accepted},
      {"IRINIT", Mode::not_tracking, &E::on_accepted},
      {"IRCHK", Mode::not_tracking, &E::on_irchk},
      {"PHRQ", Mode::set_up, &E::on_phrq},
      {"PVWR", Mode::not_tracking, &E::on_pvwr},
      {"PHSR", Mode::set_up, &E::on_phsr},
      {"PHINF", Mode::set_up, &E::on_phinf},
      {"PINIT", Mode::not_tracking, &E::on_pinit},
      {"PENA", Mode::not_tracking, &E::on_pena},
      {"PDIS", Mode::not_tracking, &E::on_pdis},
      {"PHF", Mode::not_tracking, &E::on_phf},
      {"TSTART", Mode::not_tracking, &E::on_tstart},
      {"TSTOP", Mode::tracking_only, &E::on_tstop},
      {"TX", Mode::tracking_only, &E::on_tx},
      {"BX", Mode::tracking_only, &E::on_bx},
      {"BX2", Mode::tracking_only, &E::on_bx2},
  });
  return kVerbs;
}

Nanos NdiEmulator::byte_time() const noexcept {
  return settings_.has_line ? Nanos{10'000'000'000 / static_cast<std::int64_t>(baud_)} : Nanos{0};
}

NdiError NdiEmulator::okay() noexcept {
  reply_.text("OKAY");
  return NdiError::none;
}

void NdiEmulator::receive(std::span<const std::byte> bytes, Instant now) noexcept {
  catch_up(now);
  if (now < deaf_until_) return;
  Instant at = now;
  for (const std::byte byte : bytes) {
    at += byte_time();
    const auto letter = std::to_integer<char>(byte);
    if (letter == '\r') {
      obey({line_.data(), line_size_}, at);
      line_size_ = 0;
      line_too_long_ = false;
    } else if (line_size_ == 0 && static_cast<unsigned char>(letter) <= ' ') {
      continue;  // left over between lines
    } else if (line_size_ == line_.size()) {
      line_too_long_ = true;
    } else {
      line_[line_size_++] = letter;
    }
  }
}

NdiError NdiEmulator::objection_to(Mode mode) const noexcept {
  if (mode == Mode::any) return NdiError::none;
  if (!initialised_) return NdiError::not_initialised_system;
  if (mode == Mode::not_tracking && tracking_) return NdiError::wrong_mode;
  if (mode == Mode::tracking_only && !tracking_) return NdiError::wrong_mode;
  return NdiError::none;
}

NdiError NdiEmulator::dispatch(const CommandLine& command, const Moment& moment) noexcept {
  if (command.error != NdiError::none) return command.error;
  const auto all = verbs();
  const auto verb = std::find_if(all.begin(), all.end(), [&](const Verb& v) {
    return std::ranges::equal(v.name, command.name, {}, {}, upper);  // devices take small letters as well
  });
  if (verb == all.end() || !model_.knows(verb->name)) return NdiError::invalid_command;
  const NdiError objection = objection_to(verb->mode);
  return objection != NdiError::none ? objection : (this->*verb->handler)(command.arguments, moment);
}

void NdiEmulator::obey(std::string_view line, Instant complete_at) noexcept {
  if (line.empty() && !line_too_long_) return;
  suffer_tool_faults(complete_at);
  reply_.clear();
  binary_reply_ = false;
  const NdiError error =
      line_too_long_ ? NdiError::too_long : dispatch(parse_command_line(line), moment_at(complete_at));
  if (complete_at < deaf_until_) return;  // it was told to restart
  if (error != NdiError::none) {
    reply_.clear();
    binary_reply_ = false;
    reply_.text("ERROR");
    reply_.hex(static_cast<std::uint32_t>(error), 2);
  }
  if (binary_reply_) {
    reply_.finish_binary();
  } else {
    reply_.finish_text();
  }
  send(complete_at);
  if (next_baud_ != baud_) switch_at_ = replies_.busy_until() + kSwitchAfter;
}

void NdiEmulator::send(Instant now) noexcept {
  const std::uint64_t reply = replies_sent_++;
  if (faults_.active(NdiFault::silence, now, reply) != nullptr) return;
  std::span<std::byte> bytes = reply_.bytes();
  damage(bytes, now);
  Instant begins = std::max(now + settings_.processing_time, replies_.busy_until());
  if (const auto* late = faults_.active(NdiFault::late, now, reply))
    begins += Nanos{late->amount * 1'000'000};
  if (const auto* cut = faults_.active(NdiFault::truncated, now, reply)) {
    bytes =
        bytes.first(std::min(bytes.size(), static_cast<std::size_t>(std::max<std::int64_t>(0, cut->amount))));
  }
  replies_.push(bytes, begins, byte_time(), settings_.packet_bytes);
}

void NdiEmulator::damage(std::span<std::byte> bytes, Instant now) noexcept {
  const std::uint64_t reply = replies_sent_ - 1;
  if (faults_.active(NdiFault::garbage, now, reply) != nullptr) {
    std::uint32_t state = static_cast<std::uint32_t>(reply) * 2654435761u + 12345u;
    for (std::byte& byte : bytes) {
      state = state * 1664525u + 1013904223u;
      byte = static_cast<std::byte>(state >> 24);
    }
  }
  if (faults_.active(NdiFault::bad_crc, now, reply) != nullptr) bytes[bytes.size() / 2] ^= std::byte{0x10};
}

void NdiEmulator::run_frames_at(double rate_hz) noexcept {
  frame_rate_hz_ = rate_hz;
  clock_ = DeviceClock(settings_.on_at, settings_.frame_phase, rate_hz, settings_.clock_drift_ppm);
  frame_zero_ = last_bx2_frame_ = 0;
}

void NdiEmulator::restart(Instant now) noexcept {
  replies_.clear();
  line_size_ = 0;
  line_too_long_ = false;
  for (EmulatedPort& port : ports_) port.release();
  parameters_ = UserParameters(model_, settings_.frame_rate_hz);
  run_frames_at(settings_.frame_rate_hz);
  port_events_ = 0;
  initialised_ = tracking_ = false;
  baud_ = next_baud_ = 9600;
  frame_zero_ = last_bx2_frame_ = 0;
  deaf_until_ = now + settings_.reset_time;
  reply_.clear();
  reply_.text("RESET");
  reply_.finish_text();
  replies_.push(reply_.bytes(), deaf_until_, byte_time(), settings_.packet_bytes);
}

void NdiEmulator::catch_up(Instant now) noexcept {
  if (faults_.take_due(NdiFault::reset, now)) restart(now);
  if (faults_.take_due(NdiFault::bump, now)) self_report_.raise(SelfReport::kBump);
  if (const auto alert = faults_.take_due(NdiFault::alert, now))
    self_report_.raise(1u << std::clamp<std::int64_t>(alert->amount, 0, 31));
  if (now >= switch_at_) baud_ = next_baud_;
}

void NdiEmulator::change_host(Instant now) noexcept {
  line_size_ = 0;
  line_too_long_ = false;
  discard(now);
}

void NdiEmulator::receive_break(Instant now) noexcept {
  restart(now);
}

std::size_t NdiEmulator::read(std::span<std::byte> into, Instant now) noexcept {
  catch_up(now);
  return replies_.take(into, now);
}

void NdiEmulator::discard(Instant now) noexcept {
  catch_up(now);
  replies_.drop_arrived(now);
}

Instant NdiEmulator::next_event() const noexcept {
  return std::min(replies_.next_arrival(), faults_.next_reset());
}

}  // namespace orcart
