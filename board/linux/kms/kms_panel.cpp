// The panel's policy over a ScanOut; the card itself is another file's business.
#include "board/linux/kms/kms_panel.hpp"

#include <algorithm>
#include <cstring>

namespace orcart {

Result<std::unique_ptr<KmsPanel>, PortFault> KmsPanel::start(std::unique_ptr<ScanOut> scan_out,
                                                             Clock& clock) {
  std::unique_ptr<KmsPanel> panel(new KmsPanel(std::move(scan_out), clock));
  for (int i = 0; i < ScanOut::kBuffers; ++i) {
    const ImageDescriptor image = panel->scan_out_->buffer(i);
    if (image.planes[0].data == nullptr) continue;
    std::memset(image.planes[0].data + image.planes[0].offset_bytes, 0,
                std::size_t{image.planes[0].stride_bytes} * static_cast<std::size_t>(image.height_px));
  }
  panel->scan_out_->finish_drawing(0);
  if (auto set = panel->scan_out_->set_mode(0); !set) return tl::unexpected(set.error());
  panel->last_vblank_ = panel->scan_out_->newest_vblank().value_or(clock.now());
  panel->look_at_ = clock.now() + kLook;
  return panel;
}

int KmsPanel::free_buffer() const noexcept {
  int i = 0;
  while (i == waiting_ || i == shown_) ++i;
  return i;
}

bool KmsPanel::show_again(int buffer, Instant now) noexcept {
  try_at_ = now + kLook;
  if (!scan_out_->set_mode(buffer)) return false;
  ++modes_set_anew_;
  last_vblank_ = scan_out_->newest_vblank().value_or(clock_.now());
  return true;
}

void KmsPanel::look_at_connector(Instant now) noexcept {
  if (now < look_at_) return;
  look_at_ = now + kLook;
  const bool connected = scan_out_->connected();
  if (!connected) {
    unplugged_ = true;
  } else if (unplugged_ && show_again(shown_, now)) {
    unplugged_ = false;
    waiting_ = kNone;  // its flip is void; the next picture is drawn soon
  }
}

void KmsPanel::came_onto_panel(Instant at) noexcept {
  if (flip_count_ == flips_.size()) {
    first_flip_ = (first_flip_ + 1) % flips_.size();
    --flip_count_;
  }
  flips_[(first_flip_ + flip_count_++) % flips_.size()] = {.serial = waiting_serial_, .at = at};
  shown_ = waiting_;
  waiting_ = kNone;
  last_vblank_ = at;
}

void KmsPanel::collect_flips() noexcept {
  for (int i = 0; i < 4; ++i) {
    const auto event = scan_out_->next_flip();
    if (!event) return;
    if (waiting_ != kNone && event->serial == waiting_serial_)
      came_onto_panel(event->at);  // else of an old mode
  }
}

// A flip may have come while its picture's successor was drawn slowly: it is looked for before it is missed.
void KmsPanel::free_a_hung_pipe(Instant now) noexcept {
  collect_flips();
  if (waiting_ == kNone || now < handed_over_at_ + kFlipPatience || now < try_at_) return;
  if (show_again(waiting_, now)) {
    came_onto_panel(last_vblank_);
  } else if (now >= handed_over_at_ + kHangPatience) {
    given_up_ = true;
  }
}

std::optional<PortFault> KmsPanel::trouble(Instant now) noexcept {
  if (given_up_) return PortFault::io;
  look_at_connector(now);
  if (unplugged_) return PortFault::disconnected;
  free_a_hung_pipe(now);
  if (given_up_) return PortFault::io;
  return std::nullopt;
}

Result<ImageDescriptor, PortFault> KmsPanel::acquire() noexcept {
  if (const auto fault = trouble(clock_.now())) return tl::unexpected(*fault);
  if (drawing_ == kNone) drawing_ = free_buffer();
  return scan_out_->buffer(drawing_);
}

Result<std::uint64_t, PortFault> KmsPanel::present(Instant now) noexcept {
  if (const auto fault = trouble(now)) return tl::unexpected(*fault);
  if (drawing_ == kNone) return tl::unexpected(PortFault::unsupported);
  if (waiting_ != kNone) return tl::unexpected(PortFault::busy);
  scan_out_->finish_drawing(drawing_);
  if (auto flipped = scan_out_->flip(drawing_, serial_ + 1); !flipped) {
    if (flipped.error() == PortFault::disconnected) unplugged_ = true;
    return tl::unexpected(flipped.error());
  }
  waiting_ = drawing_;
  drawing_ = kNone;
  waiting_serial_ = ++serial_;
  handed_over_at_ = now;
  return serial_;
}

std::optional<Flip> KmsPanel::take_flip(Instant now) noexcept {
  if (!unplugged_ && !given_up_) free_a_hung_pipe(now);
  if (flip_count_ == 0) return std::nullopt;
  const Flip flip = flips_[first_flip_];
  first_flip_ = (first_flip_ + 1) % flips_.size();
  --flip_count_;
  return flip;
}

// Of an instant before the newest vblank too: a picture is late by the one that it should have made.
Instant KmsPanel::next_vblank(Instant now) const noexcept {
  const Nanos period = period_of(scan_out_->mode().refresh_hz), since = now - last_vblank_;
  const auto before =
      since / period - (since % period < Nanos{0} ? 1 : 0);  // vblanks up to now, rounded down
  return last_vblank_ + (before + 1) * period;
}

}  // namespace orcart
