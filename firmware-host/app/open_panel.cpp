// A GPU's buffers are shown without a copy; a software renderer draws into memory that the card shows.
#include "firmware-host/app/open_panel.hpp"

#include "board/linux/kms/drm_scan_out.hpp"
#include "board/linux/kms/kms_panel.hpp"

namespace orcart {
namespace {

/// Whether EGL on this card's GBM device is a GPU's, and may draw into what the card shows.
bool renders_on(gbm_device* device) {
  if (device == nullptr) return false;
  const auto context = GlContext::create({.gbm_device = device});
  return context && context->render_class() == RenderClass::gpu && context->can_import_dma_buf();
}

}  // namespace

Result<OpenedPanel> open_panel(const PanelConfig& config, Clock& clock) {
  auto opened = DrmScanOut::open(config.device);
  if (!opened) return tl::unexpected(opened.error());
  std::unique_ptr<DrmScanOut> card = std::move(*opened);
  const bool wants_gpu = config.buffers == PanelBuffersWish::gpu;
  const bool may = config.buffers == PanelBuffersWish::automatic && card->turns_by_itself();
  bool on_gpu = wants_gpu || (may && renders_on(card->gbm()));
  auto made = card->make_buffers(on_gpu ? PanelBuffers::gpu : PanelBuffers::mapped);
  if (!made && on_gpu && !wants_gpu) {
    on_gpu = false;
    made = card->make_buffers(PanelBuffers::mapped);
  }
  if (!made) return tl::unexpected(made.error());
  OpenedPanel result;
  if (on_gpu) result.display.gbm_device = card->gbm();
  const PanelMode mode = card->mode();
  result.sentence = "panel: " + std::to_string(mode.width_px) + "x" + std::to_string(mode.height_px) +
                    " at " + std::to_string(mode.refresh_hz) + " Hz, pictures " +
                    (on_gpu ? "shown as rendered" : "read back into the card's memory");
  auto panel = KmsPanel::start(std::move(card), clock);
  if (!panel)
    return fail("the panel's mode cannot be set: " + std::string(word_for(panel.error())) +
                "; another [panel] mode, or a cable that carries it, may do");
  result.panel = std::move(*panel);
  return result;
}

}  // namespace orcart
