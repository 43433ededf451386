// How visible the joins between overlapping pictures are: the step of grey across them.
#pragma once

#include <string>
#include <vector>

#include "tools/evaluate/recorded/flat_painting.hpp"
#include "tools/evaluate/statistics.hpp"

namespace orcart {

/// Over the places of all joins of one painting.
struct LightStep {
  std::string name;         ///< of the light model
  Statistics grey;          ///< of 255, unsigned; one group a pair of views
  double percent = 0;       ///< mean, of the brighter side
  std::size_t clipped = 0;  ///< places left out, where either side is white (250 and more): no step can show
};

/// A place on a join, where the newest view ends on an older one.
struct JoinPlace {
  std::size_t older = 0, newer = 0;  ///< views, from 0
  cv::Point pixel;
};

/// One place a millimetre of every join in a painting of several views.
std::vector<JoinPlace> joins_of(const FlatPainting& together);

/// The step at each join: bright paper (the upper quartile of grey) of the one and the other view alone, over
/// the very pixels within `reach_mm` that both paint; so a pattern that does not fit together is no step.
/// `alone` holds one painting a view.
LightStep step_across(const std::string& name, const std::vector<JoinPlace>& joins,
                      const std::vector<FlatPainting>& alone, double reach_mm);

}  // namespace orcart
