// Chooses at build time: SDL's window, or a refusal.
#include "firmware-host/app/preview.hpp"

#if ORCART_WITH_WINDOW
#include "board/sim/window/preview_window.hpp"
#endif

namespace orcart {

#if ORCART_WITH_WINDOW
namespace {

class WindowPreview final : public Preview {
 public:
  explicit WindowPreview(std::unique_ptr<PreviewWindow> window) : window_(std::move(window)) {}
  PanelObserver& observer() override { return *window_; }
  LivePedal& pedal() override { return window_->pedal(); }
  bool quit_asked() const override { return window_->quit_asked(); }

 private:
  std::unique_ptr<PreviewWindow> window_;
};

}  // namespace

Result<std::unique_ptr<Preview>> Preview::open(const PanelMode& mode, Clock& clock) {
  auto window = PreviewWindow::open(mode, "orcart (space: pedal, q: quit)", clock);
  if (!window) return tl::unexpected(window.error());
  return std::make_unique<WindowPreview>(std::move(*window));
}
#else
Result<std::unique_ptr<Preview>> Preview::open(const PanelMode&, Clock&) {
  return fail("this build has no preview window; build with -DORCART_WITH_WINDOW=ON, or use --panel png");
}
#endif

}  // namespace orcart
