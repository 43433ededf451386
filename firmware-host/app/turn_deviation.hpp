// How well the turn of an angled scope's light post is known, by what tells it.
#pragma once

#include "firmware-host/app/cart_config.hpp"
#include "firmware-host/tracker/ndi_settings.hpp"
#include "realtime/optics/scope_model.hpp"

namespace orcart {

/// Standard deviation, rad. As [scope] turn_deviation_deg tells; else by a second marker: both bodies' noise;
/// by the notch, or told by one of its pictures: what the passport says of it, else what is assumed; by an
/// encoder: that of its zero, told so, and a count's width. Any thread.
double turn_deviation_rad(const CartConfig& config, const Turning& turning, const NdiSettings& tracker);

}  // namespace orcart
