// The error that each painted texel must be expected to have, and whether independent draws agree.
#pragma once

#include "firmware-host/files/views_file.hpp"
#include "render/atlas/atlas_layout.hpp"
#include "render/atlas/texel_record.hpp"
#include "tools/evaluate/propagation.hpp"
#include "tools/evaluate/simulation.hpp"
#include "tools/evaluate/turned_scenes.hpp"
#include "tools/evaluate/view_velocities.hpp"

namespace orcart {

/// What was painted, and by which view: the atlas with the record of each texel. Lent.
struct PaintedTexels {
  const AtlasLayout& layout;
  const AtlasRecords& records;  ///< captures are numbered as the views are, from 1
  const std::vector<View>& views;
  std::vector<const TurnedScene*> scenes;  ///< one a view, at the turn of its light post
};

/// The scene of each view.
std::vector<const TurnedScene*> scenes_of(const std::vector<View>& views, TurnedScenes& scenes);

/// RMS along the surface, mm, by first-order propagation through the capture that painted the texel; negative
/// where nothing is painted or a ray grazes. Two threads.
std::vector<float> predicted_rms_mm(const std::vector<Eigen::Vector3d>& fiducials_M_mm,
                                    const PaintedTexels& painted);

/// How many points independent draws put onto another sheet of surface, or beside all.
struct DrawnCoverage {
  Coverage coverage;  ///< on the same sheet: what a prediction to the tangent plane can answer for
  std::size_t jumped = 0, lost = 0;
};

/// `setups` times: every error is drawn anew, and for painted texels of chance (eight a view) it is counted
/// whether the light that belongs there lands within the predicted 95 % ellipse.
DrawnCoverage drawn_coverage(const std::vector<Eigen::Vector3d>& fiducials_M_mm, const PaintedTexels& painted,
                             int setups, RandomStream& random);

}  // namespace orcart
