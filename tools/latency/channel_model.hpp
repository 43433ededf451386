// Model-checks the channels between the threads, as they ship, under every order that their atomics allow.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace orcart {

enum class Channel : std::uint8_t {
  queue,
  queue_size,  ///< the queue's size as a third thread sees it
  mailbox,
  pool,  ///< and the queue by which its handles go out
  trace_ring
};

/// One atomic access of a channel's source, as the checker met it.
struct AtomicSite {
  std::string file;  ///< without its folder
  unsigned line = 0;
  bool publishes = false;  ///< its order is release
  friend bool operator==(const AtomicSite&, const AtomicSite&) = default;
};

struct ModelVerdict {
  bool holds = false;
  std::uint64_t schedules = 0;  ///< tried; the faulty one is the last
  std::string fault;            ///< what went wrong, e.g. "DATA RACE"; empty where it holds
  std::vector<std::string>
      history{};  ///< the last accesses before the fault, each with thread, order and place
  std::vector<AtomicSite> ordered{};  ///< every access that was not relaxed, once each
};

/// Runs two threads (queue_size: three) over the channel under random schedules. `weakened`: that access is
/// made relaxed, for the proof that the checker bites.
ModelVerdict check_channel(Channel channel, std::uint64_t schedules,
                           const std::optional<AtomicSite>& weakened = std::nullopt);

}  // namespace orcart
