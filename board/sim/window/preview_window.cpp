// The preview window: one thread opens it, reads its keys and copies pictures into it.
#include "board/sim/window/preview_window.hpp"

#include <cstring>
#include <future>
#include <string_view>

#include <SDL2/SDL.h>

namespace orcart {
namespace {

constexpr int kEventWait_ms = 4;

// Without a display SDL falls back to drivers that show nothing to nobody.
bool shows_to_a_person(const char* driver) {
  const std::string_view name = driver == nullptr ? "" : driver;
  return !name.empty() && name != "offscreen" && name != "dummy" && name != "evdev";
}

}  // namespace

/// Everything of SDL, made and unmade by the window's thread.
struct PreviewWindow::Screen {
  SDL_Window* window = nullptr;
  SDL_Renderer* renderer = nullptr;
  SDL_Texture* texture = nullptr;

  Screen() = default;
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;
  ~Screen() {
    if (texture != nullptr) SDL_DestroyTexture(texture);
    if (renderer != nullptr) SDL_DestroyRenderer(renderer);
    if (window != nullptr) SDL_DestroyWindow(window);
    SDL_QuitSubSystem(SDL_INIT_VIDEO);
  }

  /// Empty where it worked, else SDL's reason.
  std::string open(const PanelMode& mode, const std::string& title) {
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // SIGINT and SIGTERM belong to the program
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) return SDL_GetError();
    if (SDL_getenv("SDL_VIDEODRIVER") == nullptr && !shows_to_a_person(SDL_GetCurrentVideoDriver()))
      return "there is no display";
    window = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, mode.width_px,
                              mode.height_px, SDL_WINDOW_RESIZABLE);
    // By software: the process has an EGL of its own that SDL's must not meet.
    if (window != nullptr) renderer = SDL_CreateRenderer(window, -1, SDL_RENDERER_SOFTWARE);
    if (renderer != nullptr) {
      SDL_RenderSetLogicalSize(renderer, mode.width_px, mode.height_px);
      texture = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGB888, SDL_TEXTUREACCESS_STREAMING,
                                  mode.width_px, mode.height_px);
    }
    return texture == nullptr ? SDL_GetError() : "";
  }
};

PreviewWindow::PreviewWindow(const PanelMode& mode, Clock& clock)
    : mode_(mode),
      clock_(clock),
      handed_over_(packed_bytes(PixelFormat::xrgb8888, mode.width_px, mode.height_px)) {}

PreviewWindow::~PreviewWindow() = default;

Result<std::unique_ptr<PreviewWindow>> PreviewWindow::open(const PanelMode& mode, const std::string& title,
                                                           Clock& clock) {
  std::unique_ptr<PreviewWindow> preview(new PreviewWindow(mode, clock));
  std::promise<std::string> opened;
  auto reason = opened.get_future();
  preview->thread_ =
      std::jthread([&preview = *preview, &opened, mode, title](const std::stop_token& stopped) {
        Screen screen;
        const std::string problem = screen.open(mode, title);
        opened.set_value(problem);
        if (problem.empty()) preview.run(screen, stopped);
      });
  if (const std::string problem = reason.get(); !problem.empty())
    return fail("no window can be opened here (" + problem + "); set DISPLAY, or use --panel png");
  return preview;
}

void PreviewWindow::flipped(const ShownPicture& now, const ShownPicture* /*before*/) noexcept {
  if (full_.load(std::memory_order_acquire))
    return;  // partner: the store in draw_newest; this picture is left out
  const ImagePlane& plane = now.image.planes[0];
  std::memcpy(handed_over_.data(), plane.data + plane.offset_bytes, handed_over_.size());
  full_.store(true, std::memory_order_release);  // partner: the load in draw_newest
}

void PreviewWindow::run(Screen& screen, const std::stop_token& stopped) {
  while (!stopped.stop_requested()) {
    handle_events(screen);
    draw_newest(screen);
  }
}

void PreviewWindow::handle_events(Screen& screen) {
  SDL_Event event;
  for (int wait_ms = kEventWait_ms; SDL_WaitEventTimeout(&event, wait_ms) != 0; wait_ms = 0) {
    const bool down = event.type == SDL_KEYDOWN, up = event.type == SDL_KEYUP;
    const SDL_Keycode key = down || up ? event.key.keysym.sym : 0;
    if (key == SDLK_SPACE && event.key.repeat == 0)
      (void)pedal_.push(down ? EdgeKind::pressed : EdgeKind::released, clock_.now());
    if (event.type == SDL_QUIT || (down && (key == SDLK_q || key == SDLK_ESCAPE)))
      quit_.store(true, std::memory_order_relaxed);  // a flag alone, no partner
    if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_EXPOSED) {
      SDL_RenderCopy(screen.renderer, screen.texture, nullptr, nullptr);
      SDL_RenderPresent(screen.renderer);
    }
  }
}

void PreviewWindow::draw_newest(Screen& screen) {
  if (!full_.load(std::memory_order_acquire)) return;  // partner: the store in flipped
  SDL_UpdateTexture(screen.texture, nullptr, handed_over_.data(), 4 * mode_.width_px);
  full_.store(false, std::memory_order_release);  // partner: the load in flipped
  SDL_RenderClear(screen.renderer);
  SDL_RenderCopy(screen.renderer, screen.texture, nullptr, nullptr);
  SDL_RenderPresent(screen.renderer);
  drawn_.fetch_add(1, std::memory_order_relaxed);  // a count alone, no partner
}

}  // namespace orcart
