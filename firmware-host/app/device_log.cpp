// One line a change.
#include "firmware-host/app/device_log.hpp"

namespace orcart {
namespace {

std::string sentence_for(PortFault fault) {
  if (fault == PortFault::nothing_yet) return "works again";
  if (fault == PortFault::damaged)
    return "every frame comes damaged; another cable, port or format of the camera may do";
  return std::string(word_for(fault)) + "; tried again until it works";
}

}  // namespace

std::string DeviceLog::tracker_news(const Cart::Now& now) {
  std::string lines;
  if (now.tracker != tracker_)
    lines +=
        "tracker: " + (now.tracker.empty() ? "works again" : now.tracker + "; tried again until it works") +
        "\n";
  if (now.tracker_remark != tracker_remark_ && !now.tracker_remark.empty())
    lines += "tracker: " + now.tracker_remark + "\n";
  tracker_ = now.tracker;
  tracker_remark_ = now.tracker_remark;
  return lines;
}

std::string DeviceLog::news(const Cart::Now& now) {
  struct Watched {
    std::string_view name;
    PortFault fault;
  };
  const std::array<Watched, 4> watched{
      {{"camera", now.camera}, {"pedal", now.pedal}, {"panel", now.panel}, {"encoder", now.encoder}}};
  std::string lines;
  for (std::size_t i = 0; i < watched.size(); ++i) {
    const PortFault fault = watched[i].fault;
    if (fault == known_[i]) continue;
    known_[i] = fault;
    lines += std::string(watched[i].name) + ": " + sentence_for(fault) + "\n";
  }
  if ((now.mismatch_deg != 0) != (mismatch_deg_ != 0))
    lines += now.mismatch_deg != 0
                 ? "turn: the notch in the pictures is " + std::to_string(now.mismatch_deg) +
                       " degrees further round; nothing is painted until they agree\n"
                 : std::string("turn: agrees with the notch again\n");
  mismatch_deg_ = now.mismatch_deg;
  return lines + tracker_news(now) + session_news(now);
}

// Of a disk that is too slow the first loss alone: the run's end tells how many there were.
std::string DeviceLog::session_news(const Cart::Now& now) {
  const bool changed = now.session_failing != session_failing_;
  const bool first_loss = now.session_lost > 0 && !told_loss_;
  session_failing_ = now.session_failing;
  told_loss_ = told_loss_ || first_loss || now.session_failing;
  const std::string lost = std::to_string(now.session_lost) + " lost so far";
  if (changed && now.session_failing)
    return "session: writing fails, captures are not kept (" + lost +
           "); make room on the disk, it is tried again until it works\n";
  if (changed) return "session: captures are kept again (" + lost + ")\n";
  if (first_loss) return "session: the disk is too slow, captures are not kept (" + lost + ")\n";
  return "";
}

}  // namespace orcart
