// What the threads, frames and captures did, as a trace that Perfetto and chrome://tracing open.
#pragma once

#include <filesystem>
#include <string>

#include "firmware-host/app/cart.hpp"

namespace orcart {

/// Newest events kept of each thread for `orcartd --trace`: about two minutes of the busiest one.
inline constexpr std::size_t kTracedEvents = 65'535;

/// Trace Event Format (JSON): a track a thread with its steps, slips and late wake-ups, and a track each for
/// frames (dequeued to scan-out) and captures (edge to panel). Instants in microseconds since the earliest.
/// After stop().
std::string trace_of(const Cart& cart);

/// Writes it; never half a file.
Result<void> write_trace(const std::filesystem::path& file, const Cart& cart);

}  // namespace orcart
