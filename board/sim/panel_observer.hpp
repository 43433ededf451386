// Who wants to see what a simulated panel shows: pictures are lent at every flip, while they cannot change.
#pragma once

#include "board/ports/panel.hpp"

namespace orcart {

/// A picture that is, or was, on the panel; the pixels are lent for the call only.
struct ShownPicture {
  Flip flip;
  ImageDescriptor image;
};

/// Called in the thread that drives the panel: copy little and return; nothing here may block.
class PanelObserver {
 public:
  virtual ~PanelObserver() = default;
  /// `now` has come onto the panel; `before` (null at the first flip) was on it until now.flip.at.
  virtual void flipped(const ShownPicture& now, const ShownPicture* before) noexcept = 0;
};

}  // namespace orcart
