// Waiting presses in their order, and at most one stream.
#include "realtime/sync/capture_selector.hpp"

namespace orcart {

bool CaptureSelector::request(const CaptureRequest& request) noexcept {
  if (count_ == kMostWaiting) return false;
  if (request.edge_at <= last_unclaimed_) ++late_edges_;
  waiting_[count_++] = {request, Refusal::no_frame};
  return true;
}

void CaptureSelector::begin_stream(const CaptureRequest& request) noexcept {
  stream_ = request;
  stream_->streaming = true;
  stream_until_ = Instant::max();
}

void CaptureSelector::end_stream(Instant released_at) noexcept {
  stream_until_ = released_at;
}

bool CaptureSelector::cancel(std::uint32_t unit) noexcept {
  bool found = stream_ && stream_->unit == unit;
  if (found) stream_.reset();
  for (std::size_t i = count_; i > 0; --i) {
    if (waiting_[i - 1].unit != unit) continue;
    (void)remove(i - 1);
    found = true;
  }
  return found;
}

std::optional<CaptureRequest> CaptureSelector::claim(const MatchedFrame& matched) noexcept {
  const Instant mid = matched.frame.mid_exposure();
  for (std::size_t i = 0; i < count_; ++i) {
    if (waiting_[i].edge_at > mid) continue;
    if (matched.refusal == Refusal::none) return remove(i);
    waiting_[i].reason = matched.refusal;
  }
  if (matched.refusal != Refusal::none) return std::nullopt;
  if (stream_ && mid > stream_until_) stream_.reset();
  if (stream_ && mid >= stream_->edge_at) return stream_;
  last_unclaimed_ = mid;
  return std::nullopt;
}

std::optional<CaptureSelector::Failed> CaptureSelector::next_failed(Instant now) noexcept {
  for (std::size_t i = 0; i < count_; ++i)
    if (now >= waiting_[i].edge_at + settings_.patience) return remove(i);
  return std::nullopt;
}

CaptureSelector::Failed CaptureSelector::remove(std::size_t index) noexcept {
  const Failed removed = waiting_[index];
  for (std::size_t i = index + 1; i < count_; ++i) waiting_[i - 1] = waiting_[i];
  --count_;
  return removed;
}

}  // namespace orcart
