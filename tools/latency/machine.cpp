// One look a cause, each at one file.
#include "tools/latency/machine.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "realtime/kernel/realtime_rights.hpp"

namespace orcart {
namespace {

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

long number_in(const std::filesystem::path& file, long otherwise) {
  const std::string line = first_line(file);
  return line.empty() ? otherwise : std::strtol(line.c_str(), nullptr, 10);
}

std::string processor_in(const std::filesystem::path& proc) {
  std::ifstream in(proc / "cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

bool is_virtual(const std::filesystem::path& proc) {
  std::ifstream in(proc / "cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("flags")) return line.find(" hypervisor") != std::string::npos;
  return false;
}

bool fifo_allowed() {
  bool allowed = false;
  std::thread([&] { allowed = acquire_thread_rights({.name = "ask", .fifo_priority = 80}).fifo; }).join();
  return allowed;
}

void look_at_kernel(const std::filesystem::path& root, MachineFacts& facts) {
  facts.preempt_rt = number_in(root / "sys/kernel/realtime", 0) == 1;
  if (!facts.preempt_rt)
    facts.causes.push_back(
        {"The kernel is not PREEMPT_RT: drivers and interrupts can hold a thread for milliseconds.",
         "Install linux-image-rt-amd64 and boot it."});
  const long runtime = number_in(root / "proc/sys/kernel/sched_rt_runtime_us", -1);
  const long period = number_in(root / "proc/sys/kernel/sched_rt_period_us", 1'000'000);
  if (runtime >= 0 && runtime < period)
    facts.causes.push_back({"Real-time threads are throttled: at most " + std::to_string(runtime) +
                                " us in every " + std::to_string(period) + " us (sched_rt_runtime_us).",
                            "Set kernel.sched_rt_runtime_us=-1 in /etc/sysctl.d."});
  if (is_virtual(root / "proc"))
    facts.causes.push_back({"This is a virtual machine: its host takes the processor away without telling.",
                            "Run the cart on hardware of its own."});
}

void look_at_processors(const std::filesystem::path& root, MachineFacts& facts) {
  const auto cpus = root / "sys/devices/system/cpu";
  if (first_line(cpus / "isolated").empty())
    facts.causes.push_back(
        {"No processor is isolated: other programs and interrupts run beside the real-time threads.",
         "Add isolcpus=, nohz_full= and irqaffinity= to the kernel line (board/cart)."});
  std::error_code error;
  long deepest_us = 0;
  for (const auto& state : std::filesystem::directory_iterator(cpus / "cpu0/cpuidle", error))
    if (number_in(state.path() / "disable", 0) == 0)
      deepest_us = std::max(deepest_us, number_in(state.path() / "latency", 0));
  if (deepest_us > 10)
    facts.causes.push_back({"Idle processors sleep so deeply that they need " + std::to_string(deepest_us) +
                                " us to wake (C-states).",
                            "Add processor.max_cstate=1 intel_idle.max_cstate=0 to the kernel line, or hold "
                            "/dev/cpu_dma_latency at 0."});
  const std::string governor = first_line(cpus / "cpu0/cpufreq/scaling_governor");
  if (!governor.empty() && governor != "performance")
    facts.causes.push_back({"The processor's clock follows its load (governor " + governor + ").",
                            "Set the governor to performance: cpupower frequency-set -g performance."});
  const long throttled = number_in(cpus / "cpu0/thermal_throttle/core_throttle_count", 0);
  if (throttled > 0)
    facts.causes.push_back({"The processor was throttled " + std::to_string(throttled) +
                                " times since it was started: it gets too hot.",
                            "Clean the fans, and see that the cart's air vents are free."});
}

void look_at_rights(MachineFacts& facts) {
  facts.fifo = fifo_allowed();
  if (!facts.fifo)
    facts.causes.push_back({"No right to SCHED_FIFO: any other program can delay the real-time threads.",
                            "Set LimitRTPRIO=82 in the service, or `ulimit -r 82` in the shell."});
  const RealtimeRights memory = lock_process_memory();
  unlock_process_memory();
  facts.memory_lock = memory.memory_locked;
  if (!facts.memory_lock)
    facts.causes.push_back(
        {"Memory cannot be locked: a page may have to be fetched in the middle of a step.",
         "Set LimitMEMLOCK=infinity in the service, or `ulimit -l unlimited` in the shell."});
}

}  // namespace

MachineFacts look_at_machine(const std::filesystem::path& root) {
  MachineFacts facts;
  facts.name = processor_in(root / "proc") + ", " + std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) +
               " cores, Linux " + first_line(root / "proc/sys/kernel/osrelease");
  look_at_kernel(root, facts);
  look_at_processors(root, facts);
  look_at_rights(facts);
  return facts;
}

}  // namespace orcart
