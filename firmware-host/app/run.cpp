// Read, arm, run, stop, judge, report: in this order, with a progress line all the while.
#include "firmware-host/app/run.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <optional>

#include "firmware-host/app/budget_log.hpp"
#include "firmware-host/app/capture_log.hpp"
#include "firmware-host/app/cart.hpp"
#include "firmware-host/app/device_log.hpp"
#include "firmware-host/app/devices.hpp"
#include "firmware-host/app/heartbeat.hpp"
#include "firmware-host/app/kept_session.hpp"
#include "firmware-host/app/preview.hpp"
#include "firmware-host/app/run_figures.hpp"
#include "firmware-host/app/trace_file.hpp"
#include "firmware-host/app/truth_check.hpp"
#include "firmware-host/report/contact_sheet.hpp"
#include "render/views/screen.hpp"

namespace orcart {
namespace {

volatile std::sig_atomic_t stop_asked = 0;
void ask_to_stop(int) {
  stop_asked = 1;
}

void catch_signals() {
  struct sigaction action {};
  action.sa_handler = ask_to_stop;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

/// Makes the report's folder, so that a run is not made in vain.
Result<void> make_ready(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && access(folder.c_str(), W_OK) == 0) return {};
  return fail("--report " + folder.string() + ": no report can be written there (" +
              (error ? error : std::error_code(errno, std::generic_category())).message() +
              "); name a folder that may be made and written to");
}

ExitCode complain(const Error& error, ExitCode code) {
  std::fprintf(stderr, "orcartd: %s\n", error.message.c_str());
  return code;
}

/// One line that is written over while it goes on, where a person looks; now and then a line elsewhere.
class Progress {
 public:
  void show(const char* what, double done) {
    const int percent = static_cast<int>(done * 100);
    if (percent == last_ && what == what_) return;
    if (isatty(STDERR_FILENO) == 0 && percent / 10 == last_ / 10 && what == what_) return;
    std::fprintf(stderr, isatty(STDERR_FILENO) != 0 ? "\r%s %3d %%   " : "%s %d %%\n", what, percent);
    last_ = percent;
    what_ = what;
  }
  void end() {
    if (last_ >= 0 && isatty(STDERR_FILENO) != 0) std::fputc('\n', stderr);
    last_ = -1;
    what_ = nullptr;
  }

 private:
  int last_ = -1;
  const char* what_ = nullptr;
};

/// The session's thread is left out: a slow disk stops captures, never the live picture.
std::vector<WatchedThread> watched_threads(const Cart& cart) {
  std::vector<WatchedThread> watched;
  for (std::size_t i = 0; i < cart.thread_ledgers().size(); ++i) {
    const ThreadSpec& spec = kThreads[i].spec;
    if (spec.fifo_priority > 0) watched.push_back({.name = spec.name, .ledger = cart.thread_ledgers()[i]});
  }
  return watched;
}

/// Lets the cart go through the procedure; its coverage as it grew. Ends early when the panel hangs.
Result<std::vector<CoveragePoint>> go(Cart& cart, const Devices& devices, Clock& clock,
                                      SimulatedClock* simulated, const Preview* preview, Progress& progress) {
  std::vector<CoveragePoint> coverage;
  std::optional<Heartbeat> heartbeat;
  BudgetLog misses;
  if (simulated == nullptr) {
    if (auto started = cart.start(); !started) return tl::unexpected(started.error());
    heartbeat.emplace(ServiceManager::from_environment(), watched_threads(cart), clock);
  }
  const bool ends = devices.end() != Instant::max();
  const Instant end = ends ? devices.end() + 500ms : Instant::max();
  const auto quit = [&] { return stop_asked != 0 || (preview != nullptr && preview->quit_asked()); };
  DeviceLog devices_log;
  CaptureLog captures_log;
  while (clock.now() < end && !quit()) {
    const Instant next = std::min(end, clock.now() + 250ms);
    if (simulated != nullptr) {
      cart.run_simulated(*simulated, next);
    } else {
      clock.sleep_until(next);
    }
    const double at_s = seconds(clock.now() - devices.start());
    const Cart::Now now = cart.now();
    if (at_s >= 0) coverage.push_back({.at_s = at_s, .covered = now.coverage});
    if (const std::string news = devices_log.news(now) + captures_log.news(cart.captures()); !news.empty()) {
      progress.end();
      std::fputs(news.c_str(), stderr);
    }
    for (const std::string& line : misses.news(cart.stage_ledgers(), clock.now())) {
      progress.end();
      std::fprintf(stderr, "orcartd: %s\n", line.c_str());
    }
    if (now.panel == PortFault::io) return fail("the panel hangs: no picture came onto it for a second");
    if (ends) progress.show("procedure", std::max(0.0, at_s / seconds(end - devices.start())));
  }
  progress.end();
  return coverage;
}

std::vector<JudgedView> views_of(const Cart& cart, const SimulatedWorld& world, std::size_t most) {
  std::vector<JudgedView> views;
  for (std::size_t i = 0; i < cart.captures().size() && views.size() < most; ++i) {
    const CaptureRecord& c = cart.captures().at(i);
    if (c.refusal == Refusal::none && !c.streaming)
      views.push_back({.believed = c.X_MC,
                       .true_pose = world.X_MC(c.mid_exposure),
                       .believed_turn_rad = c.turn_rad,
                       .true_turn_rad = world.turn_rad(c.mid_exposure)});
  }
  return views;
}

Result<void> judge_painting(RunReport& report, const Patient& patient, const CartConfig& config,
                            const std::vector<JudgedView>& views, Progress& progress) {
  struct Case {
    std::string name;
    TextureMode mode;
    bool exact;
  };
  char noise[96];
  std::snprintf(noise, sizeof noise, "as run: %s, %.2f mm on each marker",
                config.mode == TextureMode::paper ? "paper" : "perspective",
                config.simulation.marker_noise_mm);
  const std::array<Case, 3> cases{{{noise, config.mode, false},
                                   {"perspective, exact poses", TextureMode::perspective, true},
                                   {"paper mode, exact poses", TextureMode::paper, true}}};
  for (const Case& one : cases) {
    std::vector<JudgedView> judged = views;
    if (one.exact) {
      for (JudgedView& view : judged) {
        view.believed = view.true_pose;
        view.believed_turn_rad = view.true_turn_rad;
      }
    }
    auto error = check_painting(
        patient, judged,
        {.name = one.name, .seen_from = config.seen_from, .mode = one.mode, .format = config.camera.format},
        [&](double done) { progress.show("painting error", done); });
    if (!error) return tl::unexpected(error.error());
    report.errors.push_back(std::move(*error));
  }
  progress.end();
  return {};
}

Result<Picture> surface_picture(const Patient& patient, const Painter& painter, const CartConfig& config,
                                const Eye& eye) {
  auto drawn = picture_of_surface(patient.surface, patient.layout, painter, eye,
                                  {.width_px = 1000, .height_px = 800, .seen_from = config.seen_from});
  if (!drawn) return tl::unexpected(drawn.error());
  Picture picture;
  picture.width_px = drawn->width_texels;
  picture.height_px = drawn->height_texels;
  picture.rgba = std::move(drawn->rgba);
  return picture;
}

struct NamedPicture {
  std::string name;
  Picture picture;
};

/// Where one stands inside the painting, as the scope stood at its last capture, with a wider view.
std::optional<Eye> eye_inside(const Cart& cart) {
  constexpr double kAhead_mm = 10, kWide_rad = 1.4;
  for (std::size_t i = cart.captures().size(); i > 0; --i) {
    const CaptureRecord& c = cart.captures().at(i - 1);
    if (c.refusal != Refusal::none || c.undone) continue;
    const Eigen::Matrix3d& axes = c.X_MC.rotation;
    return Eye{.position_mm = c.X_MC.translation_mm,
               .target_mm = c.X_MC.translation_mm + kAhead_mm * axes.col(2),
               .up = -axes.col(1),
               .field_of_view_rad = kWide_rad};
  }
  return std::nullopt;
}

/// The painting alone: from two sides, as a stereo pair in both orders, and from within a cavity.
Result<std::vector<NamedPicture>> surface_pictures(Cart& cart, const Patient& patient,
                                                   const CartConfig& config) {
  const Eigen::Vector3d from(config.view_from[0], config.view_from[1], config.view_from[2]);
  const Eigen::Vector3d up(config.view_up[0], config.view_up[1], config.view_up[2]);
  const Eye front = eye_on(patient.surface.mesh, from, up);
  const EyePair pair = stereo_eyes(front);
  std::vector<std::pair<std::string, Eye>> wanted{
      {"surface-front.png", front},
      {"surface-back.png", eye_on(patient.surface.mesh, -from, up)},
      {"left", pair.left},
      {"right", pair.right}};
  const std::optional<Eye> inside = eye_inside(cart);
  if (config.seen_from == SeenFrom::inside && inside) wanted.emplace_back("surface-inside.png", *inside);
  std::vector<NamedPicture> all;
  for (const auto& [name, eye] : wanted) {
    auto picture = surface_picture(patient, cart.painter(), config, eye);
    if (!picture) return tl::unexpected(picture.error());
    all.push_back({name, std::move(*picture)});
  }
  constexpr SheetLayout kSideBySide{.columns = 2, .thumb_width_px = 800, .gap_px = 8};
  const Picture left = std::move(all[2].picture), right = std::move(all[3].picture);
  all[2] = {"stereo-parallel.png", contact_sheet({left, right}, kSideBySide)};
  all[3] = {"stereo-cross-eyed.png", contact_sheet({right, left}, kSideBySide)};
  return all;
}

Result<void> write_pictures(RunReport& report, const Options& options, Cart& cart, const Patient& patient,
                            const CartConfig& config, const Devices& devices) {
  std::vector<NamedPicture> all;
  std::vector<Picture> sheet;
  for (const Picture& panel : devices.panel_pictures())
    all.push_back({"panel-" + std::to_string(all.size() + 1) + ".png", panel});
  const std::size_t last_panel = all.empty() ? 0 : all.size() - 1;
  auto surfaces = surface_pictures(cart, patient, config);
  if (!surfaces) return tl::unexpected(surfaces.error());
  all.insert(all.end(), std::make_move_iterator(surfaces->begin()), std::make_move_iterator(surfaces->end()));
  for (const NamedPicture& one : all) {
    if (!one.name.starts_with("stereo")) sheet.push_back(one.picture);
  }
  report.pictures = {"contact-sheet.png"};
  for (std::size_t i = last_panel; i < all.size(); ++i) report.pictures.push_back(all[i].name);
  all.push_back({"contact-sheet.png", contact_sheet(sheet, {.columns = 3, .thumb_width_px = 640})});
  for (const NamedPicture& one : all) {
    if (auto written = write_png(options.report_dir / one.name, one.picture.width_px, one.picture.height_px,
                                 one.picture.rgba);
        !written)
      return written;
  }
  return {};
}

/// What the ledgers must have room for: the procedure, or a long day's where only a person ends it.
double longest_run_s(const Devices& devices) {
  constexpr double kLongDay_s = 6 * 3600;
  return devices.end() == Instant::max() ? kLongDay_s : seconds(devices.end() - devices.start()) + 10;
}

}  // namespace

ExitCode run(const Options& options) {
  catch_signals();
  auto config = read_cart(options.cart);
  if (!config) return complain(config.error(), ExitCode::configuration);
  if (options.run_for) config->simulation.duration_s = seconds(*options.run_for);
  if (options.medium) config->passport.medium = options.medium;
  if (options.turn_rad) {
    if (config->turn != TurnSource::encoder) config->turn = TurnSource::told;
    config->turn_rad = options.turn_rad;
  }
  auto patient = read_patient(*config);
  if (!patient) return complain(patient.error(), ExitCode::configuration);
  for (const std::string& note : patient->notes) std::fprintf(stderr, "%s\n", note.c_str());

  if (!options.report_dir.empty()) {
    if (auto ready = make_ready(options.report_dir); !ready) return complain(ready.error(), ExitCode::usage);
  }

  RealClock real;
  SimulatedClock simulated;
  const bool simulate = options.clock == ClockKind::simulated;
  Clock& clock = simulate ? static_cast<Clock&>(simulated) : real;
  Progress progress;
  std::unique_ptr<KeptSession> session;
  if (!options.session.empty()) {
    auto made = KeptSession::create(
        {.file = options.session, .config = *config, .patient = *patient, .started_at = clock.now()});
    if (!made) return complain(made.error(), ExitCode::usage);
    session = std::move(*made);
  }
  std::unique_ptr<Preview> preview;
  if (options.panel == PanelKind::window) {
    if (simulate)
      return complain({"--panel window needs --clock real: a person watches in real time"}, ExitCode::usage);
    const PanelConfig& panel = config->panel;
    auto opened = Preview::open(
        {.width_px = panel.width_px, .height_px = panel.height_px, .refresh_hz = panel.refresh_hz}, clock);
    if (!opened) return complain(opened.error(), ExitCode::device);
    preview = std::move(*opened);
  }
  if (simulate && (config->any_device() || options.panel == PanelKind::kms))
    return complain({"--clock simulated goes with simulated devices; real ones need --clock real"},
                    ExitCode::usage);
  auto devices = Devices::open(
      {.config = *config,
       .patient = *patient,
       .clock = clock,
       .panel = options.panel,
       .preview = preview.get(),
       .run_for = options.run_for,
       .drawing = [&](double done) { progress.show("drawing what the camera will see", done); }});
  progress.end();
  if (!devices) return complain(devices.error(), ExitCode::device);
  for (const std::string& note : (*devices)->notes()) std::fprintf(stderr, "%s\n", note.c_str());
  auto cart = Cart::create({.config = *config,
                            .patient = *patient,
                            .ports = (*devices)->ports(),
                            .clock = clock,
                            .display = (*devices)->display(),
                            .session = session ? &session->stage() : nullptr,
                            .longest_run_s = longest_run_s(**devices),
                            .traced = options.trace.empty() ? 0 : kTracedEvents});
  if (!cart) return complain(cart.error(), ExitCode::device);
  auto coverage = go(**cart, **devices, clock, simulate ? &simulated : nullptr, preview.get(), progress);
  if (!coverage) return complain(coverage.error(), ExitCode::device);
  const double memory_mb = resident_mb();
  (*cart)->stop();
  ExitCode code = ExitCode::ok;
  if (!options.trace.empty()) {
    if (auto written = write_trace(options.trace, **cart); !written)
      code = complain(written.error(), ExitCode::failed);
  }
  if (session) {
    if (auto finished = session->finish((*cart)->stage_ledgers()); !finished)
      code = complain(finished.error(), ExitCode::failed);
  }
  RunReport report = figures_of(**cart, {.config = *config,
                                         .patient = *patient,
                                         .started = (*devices)->start(),
                                         .ended = clock.now(),
                                         .resident_mb = memory_mb,
                                         .coverage = std::move(*coverage)});
  if (!options.report_dir.empty()) {
    if (auto written = write_pictures(report, options, **cart, *patient, *config, **devices); !written)
      return complain(written.error(), ExitCode::failed);
    constexpr std::size_t kViewsJudged = 8;
    const SimulatedWorld* world = (*devices)->truth();
    const auto views = world != nullptr ? views_of(**cart, *world, kViewsJudged) : std::vector<JudgedView>{};
    cart->reset();
    if (auto judged =
            world != nullptr ? judge_painting(report, *patient, *config, views, progress) : Result<void>{};
        !judged)
      return complain(judged.error(), ExitCode::failed);
    if (auto written = write_report(options.report_dir, report); !written)
      return complain(written.error(), ExitCode::failed);
  }
  std::fputs(summary_of(report, options.report_dir).c_str(), stdout);
  if (session) std::fputs(session->sentence().c_str(), stdout);
  return code;
}

}  // namespace orcart
