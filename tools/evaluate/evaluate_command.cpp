// From files to the report.
#include "tools/evaluate/evaluate_command.hpp"

#include <chrono>
#include <cmath>

#include "board/sim/scope_camera.hpp"
#include "firmware-host/files/scope_file.hpp"
#include "firmware-host/files/surface_file.hpp"
#include "firmware-host/files/views_file.hpp"
#include "tools/evaluate/marker_bodies.hpp"
#include "tools/evaluate/pair_prediction.hpp"
#include "tools/evaluate/stated_errors.hpp"
#include "tools/evaluate/turned_scenes.hpp"
#include "tools/evaluate/view_velocities.hpp"
#include "tools/mesh/mesh_pictures.hpp"

namespace orcart {

namespace {

/// Everything a scene borrows.
struct Belongings {
  Surface surface;
  RayScene rays;
  ScopeModel scope;
  RegistrationFile registration;
};

class Evaluator {
 public:
  Evaluator(const EvaluateCommand& command, const EvaluateProgress& progress, const Belongings& own,
            EvaluationScene scene)
      : command_(command), progress_(progress), own_(own), scene_(std::move(scene)) {}

  Result<void> simulate_all(EvaluationReport& report) {
    for (const auto& [name, marker_rms_mm] : command_.noises) {
      SimulationRequest request = command_.simulation;
      request.model.marker_rms_mm = marker_rms_mm;
      const auto told = [this, &request, &run = name](int done) {
        progress_(run + ": " + std::to_string(request.setups) + " set-ups",
                  static_cast<double>(done) / request.setups);
      };
      auto result = simulate(scene_, request, told);
      if (!result) return tl::unexpected(result.error());
      report.runs.push_back({.name = name, .model = request.model, .result = *std::move(result)});
    }
    return {};
  }

  /// Two captures of one place, a few millimetres and degrees apart, each believed with its own noise.
  Result<void> compare_simulated(EvaluationReport& report) {
    const ScopeCamera camera(own_.surface.mesh, own_.rays, own_.scope,
                             {.tissue = LivingTissue{}, .blur = Effect::off, .texel_mm = 0.15F});
    for (int i = 0; i < command_.pairs; ++i) {
      progress_("comparing captures", static_cast<double>(i) / command_.pairs);
      RandomStream random(command_.simulation.seed, 1'000'000 + static_cast<std::uint64_t>(i));
      const auto view = wide_view(random);
      if (!view) continue;
      Twist apart;
      apart << 1.0 * random.direction(), 0.15 * random.direction();
      const Capture first{.X_MC = *view}, second{.X_MC = moved(*view, apart)};
      const auto fiducials = fiducials_of_chance(scene_, model().fiducials, random);
      DrawnErrors errors = drawn_errors(scene_, model(), kAllComponents, fiducials, random);
      const TakenPicture a = taken(camera, first, errors, random);
      const Pose<M, C> believed_a = a.X_MC;
      errors.scope = drawn_body(scene_.scope_markers_mm, model().marker_rms_mm, random);
      errors.reference = drawn_body(scene_.reference_markers_mm, model().marker_rms_mm, random);
      const TakenPicture b = taken(camera, second, errors, random);
      PairReport pair{.first = "capture " + std::to_string(2 * i + 1),
                      .second = "capture " + std::to_string(2 * i + 2)};
      pair.found = compare(scene_, a, b, {}, random);
      pair.predicted_mm =
          predicted_apart_mm(fiducials, pair.found, {scene_, model(), first}, {scene_, model(), second});
      pair.true_mm = true_shift_mm(pair.found, {first.X_MC, believed_a}, {second.X_MC, b.X_MC});
      report.pairs.push_back(std::move(pair));
    }
    return {};
  }

  Result<void> compare_recorded(EvaluationReport& report) {
    const auto file = read_views(command_.views);
    if (!file) return tl::unexpected(file.error());
    if (auto turns = check_turns(file->views, own_.scope, command_.views); !turns) return turns;
    report.notes.push_back(text_of(velocities_of(file->views)));
    TurnedScenes turned(scene_, model(), own_.registration);
    RandomStream random(command_.simulation.seed, 2'000'000);
    const auto fiducials = fiducials_of_chance(scene_, model().fiducials, random);
    std::optional<TakenPicture> before;
    const auto judged = [&](const View& view) {
      const TurnedScene& at = turned.at(view.turn_rad);
      return JudgedCapture{at.scene, at.model, capture_of(view, at.model)};
    };
    for (std::size_t i = 0; i < file->views.size(); ++i) {
      progress_("comparing recorded pictures",
                static_cast<double>(i) / static_cast<double>(file->views.size()));
      auto picture = read_picture(file->views[i].image);
      if (!picture) return tl::unexpected(picture.error());
      if (picture->width_px != own_.scope.width_px || picture->height_px != own_.scope.height_px)
        return fail(file->views[i].image.string() + ": is " + std::to_string(picture->width_px) + "x" +
                    std::to_string(picture->height_px) + " pixels; the passport is for " +
                    std::to_string(own_.scope.width_px) + "x" + std::to_string(own_.scope.height_px));
      TakenPicture now{.picture = *std::move(picture),
                       .X_MC = file->views[i].X_MC,
                       .scope = &turned.at(file->views[i].turn_rad).scope};
      if (before) {
        PairReport pair{.first = file->views[i - 1].image.filename().string(),
                        .second = file->views[i].image.filename().string(),
                        .found = compare(scene_, *before, now, {}, random)};
        pair.predicted_mm =
            predicted_apart_mm(fiducials, pair.found, judged(file->views[i - 1]), judged(file->views[i]));
        report.pairs.push_back(std::move(pair));
      }
      before = std::move(now);
    }
    return {};
  }

  /// The surface as one view of chance would paint it, coloured by the error to be expected there.
  void add_prediction_picture(EvaluationReport& report) {
    RandomStream random(command_.simulation.seed, 3'000'000);
    const auto view = view_of_chance(scene_, random);
    if (!view) return;
    const auto fiducials = fiducials_of_chance(scene_, model().fiducials, random);
    const std::vector<double> rms_mm = predicted_at_vertices(*view, fiducials);
    const MeshColour colour = [&](const RayHit& hit, const Eigen::Vector3f&) {
      const auto& t = own_.surface.mesh.triangles[hit.triangle];
      const double a = rms_mm[t[0]], b = rms_mm[t[1]], c = rms_mm[t[2]];
      if (std::min({a, b, c}) < 0) return Eigen::Vector3f(0.75F, 0.75F, 0.75F);
      const double mm = a + static_cast<double>(hit.b1) * (b - a) + static_cast<double>(hit.b2) * (c - a);
      const auto part = static_cast<float>(std::clamp(mm / 1.0, 0.0, 1.0));  // 1 mm and more: red
      return Eigen::Vector3f(std::min(1.0F, 2 * part), std::min(1.0F, 2 - 2 * part), 0.2F);
    };
    const Eigen::Vector3f towards = -view->rotation.col(2).cast<float>(),
                          up = -view->rotation.col(1).cast<float>();
    report.pictures.push_back(
        {.name = "predicted-error.png",
         .caption =
             "What one view of chance paints, coloured by the predicted error: green 0, yellow 0.5, red 1 mm "
             "RMS and more; grey is not painted. Looked at along the view, the wall behind it left out.",
         .picture =
             draw_mesh(own_.surface.mesh, own_.rays,
                       {.width_px = 640, .from = towards, .up = up, .seen_from = scene_.seen_from}, colour)});
  }

 private:
  /// Far enough from the wall for patches of some millimetres to be seen whole; nothing where 200 were
  /// nearer.
  std::optional<Pose<M, C>> wide_view(RandomStream& random) const {
    constexpr int kTries = 200;
    constexpr float kNearestMm = 10;
    for (int i = 0; i < kTries; ++i) {
      const auto view = view_of_chance(scene_, random);
      if (view && !scene_.rays.nearest(view->translation_mm.cast<float>(),
                                       view->rotation.col(2).cast<float>(), kNearestMm))
        return view;
    }
    return std::nullopt;
  }

  ErrorModel model() const {
    ErrorModel model = command_.simulation.model;
    model.marker_rms_mm = command_.noises.front().second;
    return model;
  }

  TakenPicture taken(const ScopeCamera& camera, const Capture& capture, const DrawnErrors& errors,
                     RandomStream& random) const {
    const int width = own_.scope.width_px, height = own_.scope.height_px;
    std::vector<std::byte> bytes(packed_bytes(PixelFormat::nv12, width, height));
    ScopeCamera::Scratch scratch;
    camera.draw({.frame = random.next(),
                 .poses = {&capture.X_MC, 1},
                 .gain = camera.fitting_gain(capture.X_MC, scratch)},
                scratch, packed_image(bytes.data(), PixelFormat::nv12, width, height));
    TakenPicture made{.picture = {.width_px = width, .height_px = height, .rgba = {}},
                      .X_MC = believed_pose(scene_, capture, errors)};
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    for (std::size_t i = 0; i < pixels; ++i) {
      const auto grey = std::to_integer<std::uint8_t>(bytes[i]);
      made.picture.rgba.insert(made.picture.rgba.end(), {grey, grey, grey, 255});
    }
    return made;
  }

  struct TrueAndBelieved {
    Pose<M, C> truly, believed;
  };

  /// Where both pictures' light of the same point is painted, apart along the surface: the median.
  double true_shift_mm(const PairConsistency& pair, const TrueAndBelieved& first,
                       const TrueAndBelieved& second) const {
    std::vector<double> lengths;
    for (const PatchShift& patch : pair.patches) {
      std::array<Eigen::Vector3d, 2> painted;
      int found = 0;
      for (const TrueAndBelieved* view : {&first, &second}) {
        const Eigen::Vector3d p_C =
            view->truly.rotation.transpose() * (patch.place_mm - view->truly.translation_mm);
        const Eigen::Vector3d along = view->believed.rotation * p_C.normalized();
        const double facing = along.dot(patch.normal);
        const double distance = (patch.place_mm - view->believed.translation_mm).dot(patch.normal) / facing;
        painted[static_cast<std::size_t>(found++)] = view->believed.translation_mm + distance * along;
      }
      lengths.push_back((painted[1] - painted[0]).norm());
    }
    if (lengths.empty()) return -1;
    std::sort(lengths.begin(), lengths.end());
    return lengths[lengths.size() / 2];
  }

  /// Negative where the view does not paint.
  std::vector<double> predicted_at_vertices(const Pose<M, C>& view,
                                            const std::vector<Eigen::Vector3d>& fiducials) const {
    const ErrorSpread spread = spread_of(scene_, model(), fiducials);
    const Capture capture{.X_MC = view, .velocity = assumed_velocity(model())};
    std::vector<double> rms_mm;
    for (const auto& vertex : own_.surface.mesh.vertices_mm) {
      const Eigen::Vector3d place = vertex.cast<double>();
      const auto pixel = project(own_.scope.lens, view.rotation.transpose() * (place - view.translation_mm));
      const auto landmark = pixel ? landmark_at(scene_, view, *pixel) : std::nullopt;
      const bool seen = landmark && (landmark->place_mm - place).norm() < 0.1;
      const auto error = seen ? predict(scene_, model(), spread, capture, *landmark) : std::nullopt;
      rms_mm.push_back(error ? error->rms_mm() : -1);
    }
    return rms_mm;
  }

  const EvaluateCommand& command_;
  const EvaluateProgress& progress_;
  const Belongings& own_;
  EvaluationScene scene_;
};

Result<Belongings> read_belongings(const EvaluateCommand& command) {
  auto surface = read_surface(command.surface);
  if (!surface) return tl::unexpected(surface.error());
  auto rays = RayScene::create(surface->mesh);
  if (!rays) return tl::unexpected(rays.error());
  auto scope = read_scope(command.scope);
  if (!scope) return tl::unexpected(scope.error());
  auto registration = read_registration(command.registration);
  if (!registration) return tl::unexpected(registration.error());
  if (auto own = check_surface(*registration, surface->identity.hash); !own)
    return fail(command.registration.string() + ": " + own.error().message);
  return Belongings{.surface = *std::move(surface),
                    .rays = *std::move(rays),
                    .scope = *std::move(scope),
                    .registration = *std::move(registration)};
}

}  // namespace

Result<EvaluationReport> evaluate(const EvaluateCommand& command, const EvaluateProgress& progress) {
  const auto began = std::chrono::steady_clock::now();
  const auto own = read_belongings(command);
  if (!own) return tl::unexpected(own.error());
  auto scope_markers = markers_of_body(command.scope_rom),
       reference_markers = markers_of_body(command.reference_rom);
  if (!scope_markers) return tl::unexpected(scope_markers.error());
  if (!reference_markers) return tl::unexpected(reference_markers.error());
  EvaluationReport report{.surface = command.surface.filename().string(),
                          .surface_hash = own->surface.identity.hash,
                          .scope = own->scope.name,
                          .seen_from = command.seen_from == SeenFrom::inside ? "inside" : "outside",
                          .seed = command.simulation.seed,
                          .setups = command.simulation.setups};
  if (auto told = check_turn_told(command.simulation.model, own->scope); !told)
    return tl::unexpected(told.error());
  EvaluateCommand stated = command;
  stated.simulation.model = with_stated(command.simulation.model, own->scope, own->registration);
  report.model = stated.simulation.model;
  Evaluator evaluator(stated, progress, *own,
                      {.mesh = own->surface.mesh,
                       .rays = own->rays,
                       .scope = own->scope,
                       .seen_from = command.seen_from,
                       .X_MR = own->registration.X_MR,
                       .scope_markers_mm = *std::move(scope_markers),
                       .reference_markers_mm = *std::move(reference_markers)});
  if (auto done = evaluator.simulate_all(report); !done) return tl::unexpected(done.error());
  auto compared = command.views.empty()
                      ? (command.pairs > 0 ? evaluator.compare_simulated(report) : Result<void>{})
                      : evaluator.compare_recorded(report);
  if (!compared) return tl::unexpected(compared.error());
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  if (command.page.empty()) return report;
  progress("drawing", 0);
  evaluator.add_prediction_picture(report);
  if (auto page = write_page(command.page, report); !page) return tl::unexpected(page.error());
  return report;
}

}  // namespace orcart
