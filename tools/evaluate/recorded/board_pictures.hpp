// Pictures of a painted board: corners with how far they are off, and all views joined.
#pragma once

#include "tools/evaluate/recorded/board_mapping.hpp"

namespace orcart {

/// Green rings where corners are printed, red lines from there to where they are found.
CaptionedPicture annotated(const ViewMapping& view);

/// All views in one painting.
CaptionedPicture joined(const FlatPainting& together, const std::string& light, const LightStep& step);

}  // namespace orcart
