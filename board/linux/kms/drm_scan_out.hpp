// The display card's side of a panel: buffers in mapped memory or on the GPU, atomic commits, and what was
// there before.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "board/linux/kms/drm_card.hpp"
#include "board/linux/kms/scan_out.hpp"
#include "board/linux/kms/virtual_terminal.hpp"

struct gbm_device;

namespace orcart {

/// mapped: memory that this process writes, shown as it is (or turned by a copy). gpu: buffers that EGL draws
/// into and the card shows without a copy; they need a card, or a rotation, that allows it.
enum class PanelBuffers : std::uint8_t { mapped, gpu };

class DrmScanOut final : public ScanOut {
 public:
  /// Takes card and terminal, with no buffers yet: gpu ones want an EGL that was opened on gbm().
  static Result<std::unique_ptr<DrmScanOut>> open(const PanelWish& wish);
  /// Shows again what was there before, and gives the terminal back.
  ~DrmScanOut() override;

  /// The device to open EGL on; null where the card has none.
  gbm_device* gbm() noexcept;
  /// Whether the card's plane turns pictures by the wished angle by itself.
  bool turns_by_itself() const noexcept;
  /// Once, before anything else. Tests the commit without carrying it out; refused in a sentence.
  Result<void> make_buffers(PanelBuffers kind);
  PanelBuffers kind() const noexcept { return kind_; }

  PanelMode mode() const noexcept override { return mode_; }
  ImageDescriptor buffer(int index) noexcept override;
  void finish_drawing(int index) noexcept override;
  Result<void, PortFault> flip(int index, std::uint64_t serial) noexcept override;
  std::optional<FlipEvent> next_flip() noexcept override;
  Result<void, PortFault> set_mode(int index) noexcept override;
  std::optional<Instant> newest_vblank() noexcept override;
  bool connected() noexcept override;

 private:
  struct Buffer;
  DrmScanOut(const PanelWish& wish, DrmCard card, VirtualTerminal terminal);
  Result<void> make_mapped(Buffer& buffer);
  Result<void> make_on_gpu(Buffer& buffer);
  int commit_mode(int index, std::uint32_t flags) noexcept;

  PanelWish wish_;
  VirtualTerminal terminal_;  ///< given back last
  DrmCard card_;
  PanelMode mode_;
  PanelBuffers kind_ = PanelBuffers::mapped;
  std::unique_ptr<gbm_device, void (*)(gbm_device*)> gbm_;
  std::array<std::unique_ptr<Buffer>, kBuffers> buffers_;
  std::uint32_t mode_blob_ = 0;
  std::unique_ptr<drmModeCrtc, void (*)(drmModeCrtc*)> before_;
  std::array<std::byte, 1024> events_{};
  std::span<const std::byte> unread_;
};

}  // namespace orcart
