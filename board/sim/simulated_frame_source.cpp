// The simulated camera. Frames come by themselves as time passes; whoever looks first brings the buffers up
// to date.
#include "board/sim/simulated_frame_source.hpp"

#include <algorithm>
#include <cmath>

#include "board/sim/lattice_noise.hpp"

namespace orcart {

SimulatedFrameSource::SimulatedFrameSource(Clock& clock, const PictureSupply& pictures,
                                           const SimulatedCameraSetup& setup)
    : clock_(clock),
      pictures_(pictures),
      setup_(setup),
      timing_(pictures.timing()),
      frame_bytes_(
          packed_bytes(pictures.format().format, pictures.format().width_px, pictures.format().height_px)),
      pixels_(frame_bytes_ * setup.buffers),
      buffers_(setup.buffers) {}

void SimulatedFrameSource::wait(Instant deadline) noexcept {
  read_ahead();
  do {  // at most one round per frame until the deadline: a frame may be lost, and is no input
    clock_.sleep_until(std::min(deadline, next_event()));
    catch_up(clock_.now());
  } while (oldest_filled() == nullptr && !broken_ && clock_.now() < deadline);
}

Instant SimulatedFrameSource::next_event() const noexcept {
  if (!streaming_) return Instant::max();
  if (broken_) return break_at_;
  Instant oldest = Instant::max();
  bool room = false;
  for (const Buffer& buffer : buffers_) {
    if (buffer.place == Place::filled) oldest = std::min(oldest, ready_at(buffer.frame));
    room = room || buffer.place == Place::free;
  }
  if (oldest != Instant::max() || !room) return std::min(oldest, break_at_);
  std::uint64_t frame = next_;
  while (frame < pictures_.frame_count() && !comes(frame)) ++frame;
  return frame < pictures_.frame_count() ? std::min(ready_at(frame), break_at_) : break_at_;
}

Result<void, PortFault> SimulatedFrameSource::start() noexcept {
  const Instant now = clock_.now();
  if (streaming_) return tl::unexpected(PortFault::busy);
  for (const CameraFaultPeriod& period : setup_.faults) {
    if (setup_.start + period.from > now || now >= setup_.start + period.until) continue;
    if (period.fault == CameraFault::io) return tl::unexpected(PortFault::io);
    if (period.fault == CameraFault::disconnected) return tl::unexpected(PortFault::disconnected);
  }
  next_ = std::max(next_, first_frame_from(now - setup_.start));
  find_break(now);
  streaming_ = true;
  return {};
}

Result<void, PortFault> SimulatedFrameSource::recover() noexcept {
  streaming_ = false;
  broken_.reset();
  for (Buffer& buffer : buffers_)
    if (buffer.place == Place::filled) buffer.place = Place::free;
  auto started = start();
  if (!started) {
    streaming_ = true;
    broken_ = started.error();
  }
  return started;
}

void SimulatedFrameSource::stop() noexcept {
  streaming_ = false;
  broken_.reset();
  for (Buffer& buffer : buffers_) buffer.place = Place::free;
}

Result<FrameBuffer, PortFault> SimulatedFrameSource::take() noexcept {
  catch_up(clock_.now());
  if (broken_) return tl::unexpected(*broken_);
  Buffer* buffer = oldest_filled();
  if (buffer == nullptr) return tl::unexpected(PortFault::nothing_yet);
  if (fault_of(buffer->frame, CameraFault::damaged) != nullptr || !load(*buffer, buffer->frame)) {
    buffer->place = Place::free;
    return tl::unexpected(PortFault::damaged);
  }
  buffer->place = Place::lent;
  const CameraFaultPeriod* ahead = fault_of(buffer->frame, CameraFault::future_stamp);
  const Nanos stamp = setup_.stamp_at == StampAt::exposure_start ? timing_.start_of(buffer->frame)
                                                                 : timing_.end_of(buffer->frame);
  const FrameFormat shape = pictures_.format();
  return FrameBuffer{
      .index = static_cast<std::uint32_t>(buffer - buffers_.data()),
      .image = packed_image(pixels_of(*buffer).data(), shape.format, shape.width_px, shape.height_px),
      .sequence = buffer->sequence,
      .stamp = setup_.start + stamp + (ahead != nullptr ? ahead->amount : 0ns),
      .exposure = timing_.exposure};
}

void SimulatedFrameSource::give_back(std::uint32_t index) noexcept {
  catch_up(clock_.now());  // frames that came before found the buffer lent
  if (index < buffers_.size() && buffers_[index].place == Place::lent) buffers_[index].place = Place::free;
}

const CameraFaultPeriod* SimulatedFrameSource::fault_of(std::uint64_t frame,
                                                        CameraFault fault) const noexcept {
  const Nanos at = timing_.start_of(frame);
  for (const CameraFaultPeriod& period : setup_.faults)
    if (period.fault == fault && period.from <= at && at < period.until) return &period;
  return nullptr;
}

bool SimulatedFrameSource::comes(std::uint64_t frame) const noexcept {
  return fault_of(frame, CameraFault::off) == nullptr && fault_of(frame, CameraFault::dropped) == nullptr;
}

std::uint64_t SimulatedFrameSource::first_frame_from(Nanos since_start) const noexcept {
  const double frames = seconds(since_start - timing_.first) * timing_.rate_hz;
  return frames <= 0 ? 0 : static_cast<std::uint64_t>(std::ceil(frames));
}

std::uint64_t SimulatedFrameSource::picture_of(std::uint64_t frame) const noexcept {
  const CameraFaultPeriod* stuck = fault_of(frame, CameraFault::stuck);
  return stuck == nullptr ? frame : first_frame_from(stuck->from);
}

Instant SimulatedFrameSource::ready_at(std::uint64_t frame) const noexcept {
  const CameraFaultPeriod* late = fault_of(frame, CameraFault::delayed);
  return setup_.start + timing_.end_of(frame) + setup_.readout + (late != nullptr ? late->amount : 0ns);
}

void SimulatedFrameSource::find_break(Instant after) noexcept {
  break_at_ = Instant::max();
  for (const CameraFaultPeriod& period : setup_.faults) {
    const bool breaks = period.fault == CameraFault::io || period.fault == CameraFault::disconnected;
    const Instant at = setup_.start + period.from;
    if (!breaks || at <= after || at >= break_at_) continue;
    break_at_ = at;
    break_fault_ = period.fault == CameraFault::io ? PortFault::io : PortFault::disconnected;
  }
}

void SimulatedFrameSource::catch_up(Instant now) noexcept {
  if (!streaming_ || broken_) return;
  const Instant until = std::min(now, break_at_);
  for (; next_ < pictures_.frame_count() && ready_at(next_) <= until; ++next_) {
    if (comes(next_)) fill(next_);
    if (fault_of(next_, CameraFault::off) == nullptr) ++sequence_;
  }
  if (now >= break_at_) broken_ = break_fault_;
}

void SimulatedFrameSource::fill(std::uint64_t frame) noexcept {
  Buffer* buffer = free_buffer(picture_of(frame));
  if (buffer == nullptr) return;  // lost: the sequence counts it, nobody gets it
  buffer->place = Place::filled;
  buffer->frame = frame;
  buffer->sequence = sequence_;
}

SimulatedFrameSource::Buffer* SimulatedFrameSource::oldest_filled() noexcept {
  Buffer* oldest = nullptr;
  for (Buffer& buffer : buffers_)
    if (buffer.place == Place::filled && (oldest == nullptr || buffer.frame < oldest->frame))
      oldest = &buffer;
  return oldest;
}

SimulatedFrameSource::Buffer* SimulatedFrameSource::free_buffer(std::uint64_t picture) noexcept {
  Buffer* found = nullptr;
  for (Buffer& buffer : buffers_) {
    if (buffer.place != Place::free) continue;
    if (buffer.picture == picture) return &buffer;
    if (found == nullptr) found = &buffer;
  }
  return found;
}

bool SimulatedFrameSource::load(Buffer& buffer, std::uint64_t frame) noexcept {
  const std::span<std::byte> pixels = pixels_of(buffer);
  if (fault_of(frame, CameraFault::garbage) != nullptr) {
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = static_cast<std::byte>(hash32(static_cast<std::uint32_t>(frame * pixels.size() + i)));
    buffer.picture = kNoPicture;
    return true;
  }
  if (buffer.picture == picture_of(frame)) return true;
  const bool whole = pictures_.read(picture_of(frame), pixels);
  buffer.picture = whole ? picture_of(frame) : kNoPicture;
  return whole;
}

void SimulatedFrameSource::read_ahead() noexcept {
  if (!streaming_ || broken_ || oldest_filled() != nullptr) return;
  std::uint64_t frame = next_;
  while (frame < pictures_.frame_count() && !comes(frame)) ++frame;
  if (frame == pictures_.frame_count() || fault_of(frame, CameraFault::garbage) != nullptr) return;
  if (Buffer* buffer = free_buffer(picture_of(frame)); buffer != nullptr) (void)load(*buffer, frame);
}

std::span<std::byte> SimulatedFrameSource::pixels_of(const Buffer& buffer) noexcept {
  return std::span(pixels_).subspan(static_cast<std::size_t>(&buffer - buffers_.data()) * frame_bytes_,
                                    frame_bytes_);
}

}  // namespace orcart
