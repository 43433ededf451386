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
  return lines;
}

}  // namespace orcart
