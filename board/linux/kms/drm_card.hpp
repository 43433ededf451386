// A display card opened for one panel: its connectors, and the numbers that an atomic commit wants.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <xf86drmMode.h>

#include "board/linux/file_descriptor.hpp"
#include "board/linux/kms/panel_choice.hpp"
#include "realtime/base/result.hpp"

namespace orcart {

/// Opens a card for asking alone; a sentence where that is refused.
Result<FileDescriptor> open_card(const std::string& path);
/// Pictures in a second; what the driver says where the timings do not tell.
double refresh_of(const drmModeModeInfo& mode) noexcept;
/// In the connector's order, without the interlaced ones, which show half of a picture at a time.
std::vector<drmModeModeInfo> usable_modes(const drmModeConnector& connector);
/// Every connector with its usable modes; probes, so it takes up to half a second.
std::vector<DisplayConnector> connectors_of(int card);
std::vector<std::string> card_paths();

/// The pipe that feeds one connector, with the ids of the properties that a commit names.
struct DrmPipe {
  std::uint32_t connector = 0, crtc = 0, plane = 0;
  std::uint32_t connector_crtc = 0;
  std::uint32_t crtc_mode = 0, crtc_active = 0;
  std::uint32_t plane_fb = 0, plane_crtc = 0, plane_rotation = 0;
  std::uint32_t src_x = 0, src_y = 0, src_w = 0, src_h = 0;
  std::uint32_t crtc_x = 0, crtc_y = 0, crtc_w = 0, crtc_h = 0;
  std::uint64_t rotations = 1;  ///< bits DRM_MODE_ROTATE_* that the plane can do
  drmModeModeInfo mode{};
};

/// A card held for showing: it is DRM master, atomic, and knows its pipe.
struct DrmCard {
  FileDescriptor descriptor;
  std::string path;
  DrmPipe pipe;
};
/// Refused in one sentence: no card, no permission, held by a desktop, no atomic commits, or what choose()
/// refuses.
Result<DrmCard> take_card(const PanelWish& wish);

}  // namespace orcart
