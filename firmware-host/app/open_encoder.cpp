// One branch a kind.
#include "firmware-host/app/open_encoder.hpp"

namespace orcart {

Result<std::unique_ptr<TurnEncoder>> open_encoder(const EncoderConfig& encoder, const Clock& clock) {
  if (encoder.kind == EncoderKind::simulated) return std::unique_ptr<TurnEncoder>{};
  auto opened = EvdevEncoder::open(encoder.device, clock);
  if (!opened) return tl::unexpected(opened.error());
  return std::unique_ptr<TurnEncoder>(std::move(*opened));
}

}  // namespace orcart
