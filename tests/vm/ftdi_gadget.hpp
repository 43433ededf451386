// An FTDI bridge with an emulated tracker behind it, made by the guest for itself: dummy_hcd, configfs,
// FunctionFS. Unlike QEMU's it sends a packet of two status bytes whenever its latency timer is over, and
// takes a line's time for its bytes.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "board/linux/file_descriptor.hpp"
#include "board/sim/ndi/ndi_emulator.hpp"
#include "realtime/base/result.hpp"
#include "realtime/kernel/clock.hpp"
#include "tools/emulate/circling_tools.hpp"

struct usb_ctrlrequest;

namespace orcart::testing {

class FtdiGadget {
 public:
  /// Needs root, and the modules dummy_hcd, libcomposite and usb_f_fs. On the bus when it returns.
  static Result<std::unique_ptr<FtdiGadget>> create();
  ~FtdiGadget();
  FtdiGadget(const FtdiGadget&) = delete;
  FtdiGadget& operator=(const FtdiGadget&) = delete;

  /// Packets without a byte of the tracker's.
  std::uint64_t idle_packets() const noexcept { return idle_packets_.load(std::memory_order_relaxed); }
  std::uint64_t full_packets() const noexcept { return full_packets_.load(std::memory_order_relaxed); }
  std::uint32_t highest_baud() const noexcept { return highest_baud_.load(std::memory_order_relaxed); }

 private:
  FtdiGadget();
  void control();
  void to_tracker();
  void from_tracker();
  void answer(const usb_ctrlrequest& request);
  void obey(std::uint8_t request, std::uint16_t value, std::uint16_t index);
  bool over() const noexcept { return over_.load(std::memory_order_relaxed); }

  RealClock clock_;
  CirclingTools motion_;
  std::mutex tracker_mutex_;
  NdiEmulator tracker_;        ///< by tracker_mutex_
  std::uint32_t baud_ = 9600;  ///< by tracker_mutex_; of the bridge
  bool in_break_ = false;      ///< by tracker_mutex_
  std::atomic<int> latency_ms_{16};
  std::atomic<std::uint64_t> idle_packets_{0}, full_packets_{0};
  std::atomic<std::uint32_t> highest_baud_{0};
  std::atomic<bool> over_{false};
  FileDescriptor control_, in_, out_;
  std::vector<std::thread> threads_;
};

}  // namespace orcart::testing
