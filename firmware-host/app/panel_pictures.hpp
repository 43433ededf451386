// Keeps what the simulated panel showed at chosen instants, to be written as PNG after the run.
#pragma once

#include <vector>

#include "board/sim/panel_observer.hpp"
#include "firmware-host/files/picture_file.hpp"

namespace orcart {

/// Memory is taken in the constructor; flipped() copies one picture at most.
class PanelPictures final : public PanelObserver {
 public:
  /// The first picture shown at or after each instant is kept; instants rise.
  PanelPictures(const PanelMode& mode, std::vector<Instant> instants);

  void flipped(const ShownPicture& now, const ShownPicture* before) noexcept override;
  /// After the run: RGBA, oldest first.
  std::vector<Picture> kept() const;

 private:
  PanelMode mode_;
  std::vector<Instant> instants_;
  std::vector<std::byte> pixels_;
  std::size_t next_ = 0;
};

}  // namespace orcart
