// Reads sysfs and proc below a root, so that a test can make one.
#include "tools/probe/machine_probe.hpp"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <thread>

#include "board/linux/usb/usb_choice.hpp"
#include "realtime/kernel/realtime_rights.hpp"

namespace orcart {
namespace {

constexpr std::uint64_t kLockedMemoryWanted_bytes = 1ULL << 30;  // atlas, pictures, driver
constexpr int kPriorityWanted = 82;                              // the pedal's thread, the highest

std::string first_line(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::uint16_t usb_number(const std::filesystem::path& file) {
  const std::string digits = first_line(file);
  std::uint16_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return number;
}

bool may_open(const std::filesystem::path& usb_device) {
  const std::string bus = first_line(usb_device / "busnum"), number = first_line(usb_device / "devnum");
  const auto three = [](const std::string& n) {
    return std::string(n.size() < 3 ? 3 - n.size() : 0, '0').append(n);
  };
  const std::string node = "/dev/bus/usb/" + three(bus) + "/" + three(number);
  return ::access(node.c_str(), R_OK | W_OK) == 0 || !std::filesystem::exists(node);
}

}  // namespace

ProcessRights rights_of_this_process() {
  ProcessRights rights{.root = ::geteuid() == 0};
  rlimit limit{};
  if (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0) rights.locked_memory_bytes = limit.rlim_cur;
  // Asked for, not concluded: a container or control group may refuse even root.
  std::thread([&] {
    rights.fifo = acquire_thread_rights({.name = "ask", .fifo_priority = kPriorityWanted}).fifo;
  }).join();
  return rights;
}

std::vector<Finding> probe_trackers(const std::filesystem::path& root) {
  std::vector<Finding> found;
  std::error_code error;
  std::vector<std::filesystem::path> devices;
  for (const auto& entry : std::filesystem::directory_iterator(root / "sys/bus/usb/devices", error))
    devices.push_back(entry.path());
  std::ranges::sort(devices);
  for (const auto& device : devices) {
    const std::uint16_t vendor = usb_number(device / "idVendor"), product = usb_number(device / "idProduct");
    const std::string_view known = usb_name_of(vendor, product);
    if (known.empty()) continue;
    Finding finding{.area = "tracker", .name = std::string(known)};
    if (!is_ndi(vendor, product)) finding.name += " (a serial bridge, perhaps a tracker's)";
    const std::string serial = first_line(device / "serial");
    std::string where = "USB ";
    where.append(first_line(device / "idVendor")).append(":").append(first_line(device / "idProduct"));
    where.append(", port = \"");
    where.append(device.filename().string()).append("\"");
    if (!serial.empty()) where.append(", serial = \"").append(serial).append("\"");
    finding.details.push_back(where);
    if (!may_open(device)) {
      finding.lack = finding.name + " at USB port " + device.filename().string() + " may not be opened";
      finding.next = "install board/cart's udev rules, or join the group plugdev";
    }
    found.push_back(std::move(finding));
  }
  if (found.empty())
    found.push_back({.area = "tracker",
                     .lack = "no NDI tracker is on USB",
                     .next =
                         "plug its converter in and switch it on; a Vega on the network needs nothing here, "
                         "only kind = \"tcp\" and host"});
  return found;
}

std::vector<Finding> probe_system(const std::filesystem::path& root, const ProcessRights& rights) {
  Finding kernel{.area = "system", .name = "kernel " + first_line(root / "proc/sys/kernel/osrelease")};
  const bool preempt_rt = first_line(root / "sys/kernel/realtime") == "1";
  kernel.details.push_back(preempt_rt ? "PREEMPT_RT" : "not PREEMPT_RT");
  if (!preempt_rt) {
    kernel.lack = "the kernel is not PREEMPT_RT: wake-ups may come milliseconds late";
    kernel.next = "apt-get install linux-image-rt-amd64, and boot it";
  }
  const std::string isolated = first_line(root / "sys/devices/system/cpu/isolated");
  kernel.details.push_back("isolated processors: " + (isolated.empty() ? std::string("none") : isolated));
  std::vector<Finding> found{kernel};

  const std::string governor = first_line(root / "sys/devices/system/cpu/cpu0/cpufreq/scaling_governor");
  if (!governor.empty()) {
    Finding frequency{.area = "system", .name = "frequency governor " + governor};
    if (governor != "performance") {
      frequency.lack = "the processors change their frequency (" + governor + ")";
      frequency.next = "cpupower frequency-set -g performance";
    }
    found.push_back(frequency);
  }
  Finding memory{.area = "system", .name = "locked memory"};
  const bool enough = rights.root || rights.locked_memory_bytes >= kLockedMemoryWanted_bytes;
  memory.details.push_back(rights.root ? "unlimited, as root"
                                       : std::to_string(rights.locked_memory_bytes >> 20) + " MiB at most");
  if (!enough) {
    memory.lack = "memory cannot be locked: a page may have to be fetched in mid-procedure";
    memory.next = "start it by the systemd unit of board/cart (LimitMEMLOCK=infinity)";
  }
  found.push_back(memory);
  Finding priority{.area = "system", .name = "SCHED_FIFO"};
  priority.details.push_back("priority " + std::to_string(kPriorityWanted) +
                             (rights.fifo ? " granted" : " refused"));
  if (!rights.fifo) {
    priority.lack = "threads cannot have priority " + std::to_string(kPriorityWanted) + " of SCHED_FIFO";
    priority.next =
        rights.root ? "give this container or control group real-time time (cpu.rt_runtime_us), or leave it"
                    : "start it by the systemd unit of board/cart (LimitRTPRIO=90)";
  }
  found.push_back(priority);
  return found;
}

}  // namespace orcart
