// A record's unit and refusal are written once, before it counts as appended: reading them here needs no
// lock.
#include "firmware-host/app/capture_log.hpp"

namespace orcart {
namespace {

std::string_view hint_for(Refusal refusal) {
  const bool stamps = refusal == Refusal::stamp_in_future || refusal == Refusal::stamp_backwards;
  return stamps ? "; the camera's stamps do not mean what [camera] stamp and after_exposure_ms say" : "";
}

}  // namespace

std::string CaptureLog::news(const Ledger<CaptureRecord>& captures) {
  std::string lines;
  for (; told_ < captures.size(); ++told_) {
    const CaptureRecord& capture = captures.at(told_);
    if (capture.refusal == Refusal::none) {
      if (!capture.streaming) lines += "capture " + std::to_string(capture.unit) + " painted\n";
      continue;
    }
    lines += "capture " + std::to_string(capture.unit) +
             " painted nothing: " + std::string(word_for(capture.refusal)) +
             std::string(hint_for(capture.refusal)) + "\n";
  }
  return lines;
}

}  // namespace orcart
