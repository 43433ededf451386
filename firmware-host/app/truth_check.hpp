// How far painted light lies from where it came from: measured densely, with the shipping mapper and painter,
// on pictures that encode the surface itself. Only where the truth is known: in simulation.
#pragma once

#include <functional>
#include <vector>

#include "firmware-host/app/patient.hpp"
#include "firmware-host/report/run_report.hpp"
#include "realtime/mapper/cutout_patch.hpp"

namespace orcart {

/// A view as the cart believed it and as it was.
struct JudgedView {
  Pose<M, C> believed;
  Pose<M, C> true_pose;
  double believed_turn_rad = 0, true_turn_rad = 0;  ///< of the light post since the patient's scope
};

struct TruthCheckRequest {
  std::string name;
  SeenFrom seen_from = SeenFrom::outside;
  TextureMode mode = TextureMode::perspective;
  PixelFormat format = PixelFormat::yuyv;
};

/// For every view the simulated scope looks, from the true pose and without noise, at a surface whose grey is
/// a wave along x, y and z in three phases; each picture is painted at the believed pose; from the three
/// phases each fully painted texel tells which point of the surface its light came from. Needs a GL context
/// of its own; makes one. Waves of 20 mm: errors beyond 10 mm along an axis would be told as less.
Result<PaintingError> check_painting(const Patient& patient, const std::vector<JudgedView>& views,
                                     const TruthCheckRequest& request,
                                     const std::function<void(double done)>& progress = {});

}  // namespace orcart
