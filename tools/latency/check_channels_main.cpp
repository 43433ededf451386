// orcart-check-channels: the model checker as a program of its own, since it takes the place of operator new.
#include <cstdio>
#include <cstring>

#include "tools/latency/channel_model.hpp"

namespace {

constexpr std::uint64_t kSchedules = 20'000;

int check_all() {
  bool all = true;
  for (const auto& [channel, name] :
       {std::pair{orcart::Channel::queue, "queue"},
        std::pair{orcart::Channel::queue_size, "size of the queue"},
        std::pair{orcart::Channel::mailbox, "mailbox"}, std::pair{orcart::Channel::pool, "pool"},
        std::pair{orcart::Channel::trace_ring, "trace ring"}}) {
    const orcart::ModelVerdict verdict = orcart::check_channel(channel, kSchedules);
    std::printf("%s: %s after %llu schedules %s\n", name, verdict.holds ? "holds" : "FAILS",
                static_cast<unsigned long long>(verdict.schedules), verdict.fault.c_str());
    all = all && verdict.holds;
  }
  return all ? 0 : 1;
}

/// The queue's stores that publish, by their places in the source: the first that cannot be relaxed
/// unnoticed.
int weaken_queue() {
  const orcart::ModelVerdict shipped = orcart::check_channel(orcart::Channel::queue, 100);
  for (const orcart::AtomicSite& site : shipped.ordered) {
    if (!site.publishes) continue;
    const orcart::ModelVerdict verdict = orcart::check_channel(orcart::Channel::queue, kSchedules, site);
    if (verdict.holds) continue;
    std::printf(
        "caught: %s at schedule %llu, with the access at %s:%u relaxed; the last accesses before it:\n",
        verdict.fault.c_str(), static_cast<unsigned long long>(verdict.schedules), site.file.c_str(),
        site.line);
    for (const std::string& line : verdict.history) std::printf("  %s\n", line.c_str());
    return 1;
  }
  std::puts("not caught");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--weaken-queue") == 0) return weaken_queue();
  if (argc == 1) return check_all();
  std::fprintf(stderr,
               "orcart-check-channels takes nothing, or --weaken-queue. Example: orcart-check-channels\n");
  return 2;
}
