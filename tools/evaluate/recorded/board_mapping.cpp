// Leaves each view out, paints it, finds the board in the painting, and counts.
#include "tools/evaluate/recorded/board_mapping.hpp"

#include <chrono>
#include <cmath>

#include "firmware-host/files/scope_file.hpp"
#include "tools/calibration/board_pose.hpp"
#include "tools/evaluate/recorded/board_files.hpp"
#include "tools/evaluate/recorded/board_pictures.hpp"

namespace orcart {
namespace {

constexpr int kMargin_mm = 5;

/// Where the ray of a pixel meets the plane; nothing where it does not.
std::optional<Eigen::Vector2d> on_plane(const Lens& lens, const Pose<M, C>& X_MC,
                                        const Eigen::Vector2d& pixel) {
  const auto direction = direction_of(lens, pixel);
  if (!direction) return std::nullopt;
  const Eigen::Vector3d ray = X_MC.rotation * *direction;
  const double distance = -X_MC.translation_mm.z() / ray.z();
  if (!(distance > 0)) return std::nullopt;
  return (X_MC.translation_mm + distance * ray).head<2>();
}

/// Where a corner of the picture is found in the painting: by name where the painting's own dots or markers
/// tell names, else by being near enough to where its ray meets the plane.
std::optional<Eigen::Vector2d> found_as(const BoardCorner& corner, const Eigen::Vector2d& ray_mm,
                                        const BoardView& painting, const FlatPainting& flat,
                                        const Pattern& pattern) {
  double nearest = 0.3 * pattern.spacing_mm;
  std::optional<Eigen::Vector2d> at;
  for (const BoardCorner& painted : painting.corners) {
    const Eigen::Vector2d place =
        flat.place_mm({static_cast<float>(painted.pixel_px.x()), static_cast<float>(painted.pixel_px.y())});
    if (painting.anchor == Anchor::sure) {
      if ((painted.board_mm - corner.board_mm).norm() < 0.1 * pattern.spacing_mm) return place;
      continue;
    }
    if ((place - ray_mm).norm() >= nearest) continue;
    nearest = (place - ray_mm).norm();
    at = place;
  }
  return at;
}

Statistics of_one_view(const std::vector<double>& values) {
  GroupedValues grouped;
  grouped.add(values);
  return grouped.statistics();
}

std::vector<double> distances(const ViewMapping& view, Eigen::Vector2d PaintedCorner::*from,
                              Eigen::Vector2d PaintedCorner::*to) {
  std::vector<double> values;
  values.reserve(view.corners.size());
  for (const PaintedCorner& corner : view.corners) values.push_back((corner.*from - corner.*to).norm());
  return values;
}

/// Over all views, which are the groups.
void add_totals(BoardMappingReport& report) {
  GroupedValues error, painting;
  GroupedValues tip;
  std::vector<double> origins, apart, along;
  double sum2 = 0, corners = 0, picture2 = 0;
  for (const ViewMapping& view : report.views) {
    error.add(distances(view, &PaintedCorner::found_mm, &PaintedCorner::grid_mm));
    painting.add(distances(view, &PaintedCorner::found_mm, &PaintedCorner::ray_mm));
    tip.add(view.tip.distances_mm);
    origins.push_back(view.origin_mm);
    apart.push_back(view.tip.apart_mm);
    along.push_back(std::abs(view.tip.along_mm));
    picture2 += view.tip.picture_mm * view.tip.picture_mm / static_cast<double>(report.views.size());
    sum2 += view.lens_rms_mm * view.lens_rms_mm * static_cast<double>(view.seen);
    corners += static_cast<double>(view.seen);
  }
  report.all = error.statistics();
  report.painting = painting.statistics();
  report.origin = statistics_of(origins, origins);
  report.tip = tip.statistics();
  report.tip_3d = statistics_of(apart, apart);
  report.tip_along = statistics_of(along, along);
  report.tip_picture_mm = std::sqrt(picture2);
  report.lens_rms_mm = corners > 0 ? std::sqrt(sum2 / corners) : 0;
}

Result<TipErrors> tip_of(const LeftOut& one) {
  const Pose<B, C> believed{.rotation = one.posed.X_MC.rotation,
                            .translation_mm = one.posed.X_MC.translation_mm};
  return tip_errors({.believed = believed, .seen = one.X_CB, .X_CE = one.scope.X_CE}, one.view,
                    one.scope.lens, one.corner_sigma_px);
}

class BoardEvaluator {
 public:
  BoardEvaluator(const BoardMappingCommand& command, const MappingProgress& progress)
      : command_(command), progress_(progress) {}

  Result<BoardMappingReport> report() {
    const auto began = std::chrono::steady_clock::now();
    report_.pattern = text_of(command_.hand_eye.pattern);
    report_.mode = command_.mode == TextureMode::paper ? "paper" : "perspective";
    if (auto calibrated = calibrate(); !calibrated) return tl::unexpected(calibrated.error());
    if (auto painted = paint_each(); !painted) return tl::unexpected(painted.error());
    add_totals(report_);
    if (auto lit = compare_light(); !lit) return tl::unexpected(lit.error());
    report_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    if (command_.page.empty()) return std::move(report_);
    if (auto files = write_board_files(command_.page, extent_, left_out_); !files)
      return tl::unexpected(files.error());
    for (const ViewMapping& view : report_.views) report_.pictures.push_back(annotated(view));
    if (auto page = write_page(command_.page, report_); !page) return tl::unexpected(page.error());
    return std::move(report_);
  }

 private:
  Result<ScopeModel> scope() {
    if (!command_.scope.empty()) return read_scope(command_.scope);
    const auto told = [&](std::size_t done, std::size_t all, const std::string& what) {
      progress_("calibrating the camera: " + what, static_cast<double>(done) / static_cast<double>(all));
    };
    auto camera = calibrate_camera(
        {.images = command_.hand_eye.images, .pattern = command_.hand_eye.pattern, .name = "recorded"}, told);
    if (!camera) return tl::unexpected(camera.error());
    report_.notes.emplace_back(
        "the lens was calibrated from these very pictures; --scope names another passport");
    return std::move(camera->scope);
  }

  Result<void> calibrate() {
    auto passport = scope();
    if (!passport) return tl::unexpected(passport.error());
    const auto told = [&](std::size_t done, std::size_t all, const std::string& what) {
      progress_("finding the board: " + what, static_cast<double>(done) / static_cast<double>(all));
    };
    auto hand_eye = calibrate_hand_eye(command_.hand_eye, *passport, told);
    if (!hand_eye) return tl::unexpected(hand_eye.error());
    if (hand_eye->views.size() < 4)
      return fail("the board is seen in " + std::to_string(hand_eye->views.size()) +
                  " pictures whose corners can be told apart; four or more are accepted, since each is "
                  "painted by what the others say");
    report_.notes.insert(report_.notes.end(), hand_eye->notes.begin(), hand_eye->notes.end());
    report_.tracker_floor_mm = hand_eye->floor_mm;
    auto tracking = tracking_error(command_.still, *hand_eye);
    if (!tracking) return tl::unexpected(tracking.error());
    report_.tracking = *std::move(tracking);
    report_.tip_is_window = !passport->X_CE.translation_mm.isZero(0);
    progress_("leaving each view out", 0);
    auto left_out = leave_each_out(*hand_eye, passport->lens);
    if (!left_out) return tl::unexpected(left_out.error());
    left_out_ = *std::move(left_out);
    whole_scope_ = hand_eye->scope;
    std::vector<BoardView> boards;
    for (const LeftOut& one : left_out_) boards.push_back(one.view);
    extent_ = extent_of(boards, kMargin_mm);
    return {};
  }

  OfflinePaintOptions options(LightModel light) const {
    return {.mode = command_.mode, .texel_mm = command_.texel_mm, .light = light};
  }

  Result<FlatPainting> paint_one(LeftOut& one, LightModel light) const {
    std::vector<PosedPicture> picture{std::move(one.posed)};
    auto flat = paint_plane(extent_, one.scope, picture, options(light));
    one.posed = std::move(picture.front());
    if (!flat) return fail(one.view.image.string() + ": " + flat.error().message);
    return flat;
  }

  Result<void> paint_each() {
    for (std::size_t i = 0; i < left_out_.size(); ++i) {
      progress_("painting", static_cast<double>(i) / static_cast<double>(left_out_.size()));
      LeftOut& one = left_out_[i];
      auto flat = paint_one(one, LightModel::as_seen);
      if (!flat) return tl::unexpected(flat.error());
      ViewMapping view = corners_in_painting(one.view, command_.hand_eye.pattern, one.scope.lens,
                                             one.posed.X_MC, *std::move(flat));
      if (view.corners.empty()) report_.notes.push_back(view.image + ": no corner is found in its painting");
      auto tip = tip_of(one);
      if (!tip) return fail(one.view.image.string() + ": " + tip.error().message);
      view.tip = *std::move(tip);
      view.lens_rms_mm = rms_on_board_mm(one.scope.lens, one.X_CB, one.view.corners);
      view.origin_mm = one.origin_mm;
      report_.views.push_back(std::move(view));
    }
    return {};
  }

  /// All views together, by the one passport of all.
  Result<FlatPainting> paint_together(LightModel light) {
    std::vector<PosedPicture> pictures;
    for (const LeftOut& one : left_out_) pictures.push_back(one.posed);
    return paint_plane(extent_, whole_scope_, pictures, options(light));
  }

  Result<void> compare_light() {
    constexpr double kReach_mm = 2.5;
    const std::pair<LightModel, const char*> models[]{{LightModel::as_seen, "as seen"},
                                                      {LightModel::fixed_exposure, "fixed exposure"},
                                                      {LightModel::auto_exposure, "auto exposure"}};
    std::vector<JoinPlace> joins;
    for (const auto& [light, name] : models) {
      progress_("comparing light: " + std::string(name), static_cast<double>(report_.light.size()) / 3);
      auto together = paint_together(light);
      if (!together) return tl::unexpected(together.error());
      if (light == LightModel::as_seen) joins = joins_of(*together);
      std::vector<FlatPainting> alone;
      for (LeftOut& one : left_out_) {
        auto flat = paint_one(one, light);
        if (!flat) return tl::unexpected(flat.error());
        alone.push_back(*std::move(flat));
      }
      report_.light.push_back(step_across(name, joins, alone, kReach_mm));
      if (!command_.page.empty()) report_.pictures.push_back(joined(*together, name, report_.light.back()));
    }
    return {};
  }

  const BoardMappingCommand& command_;
  const MappingProgress& progress_;
  BoardMappingReport report_;
  std::vector<LeftOut> left_out_;
  ScopeModel whole_scope_;
  PlaneExtent extent_;
};

}  // namespace

PlaneExtent extent_of(const std::vector<BoardView>& views, int margin_mm) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9), high = -low;
  for (const BoardView& view : views)
    for (const BoardCorner& corner : view.corners) {
      low = low.cwiseMin(corner.board_mm.head<2>());
      high = high.cwiseMax(corner.board_mm.head<2>());
    }
  return {.low_mm = (low.array().floor() - margin_mm).cast<int>(),
          .high_mm = (high.array().ceil() + margin_mm).cast<int>()};
}

Result<std::vector<LeftOut>> leave_each_out(const HandEyeCalibration& calibration, const Lens& lens) {
  std::vector<LeftOut> left_out;
  for (std::size_t i = 0; i < calibration.views.size(); ++i) {
    std::vector<HandEyeView> others = calibration.views;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto fit = refine_hand_eye(others, lens, calibration.task);
    if (!fit) return tl::unexpected(fit.error());
    const HandEyeView& view = calibration.views[i];
    const auto X_CB = board_pose(view.board, fit->lens);
    if (!X_CB) return tl::unexpected(X_CB.error());
    auto picture = read_picture(view.board.image);
    if (!picture) return tl::unexpected(picture.error());
    LeftOut one{.scope = calibration.scope, .view = view.board};
    one.scope.lens = fit->lens;
    one.scope.X_SC = fit->X_SC;
    const Pose<B, C> X_BC = fit->X_TB.inverse() * view.X_TS * fit->X_SC;
    one.posed = {.picture = *std::move(picture),
                 .X_MC = {.rotation = X_BC.rotation, .translation_mm = X_BC.translation_mm}};
    one.X_CB = *X_CB;
    one.corner_sigma_px = fit->corner_sigma_px;
    one.origin_mm = ((view.X_TS * fit->X_SC * *X_CB).translation_mm - fit->X_TB.translation_mm).norm();
    left_out.push_back(std::move(one));
  }
  return left_out;
}

ViewMapping corners_in_painting(const BoardView& view, const Pattern& pattern, const Lens& lens,
                                const Pose<M, C>& X_MC, FlatPainting flat) {
  ViewMapping mapping{
      .image = view.image.filename().string(), .seen = view.corners.size(), .flat = std::move(flat)};
  const BoardView found = find_board(carried_on(mapping.flat, 0.25 * pattern.spacing_mm), pattern);
  for (const BoardCorner& corner : view.corners) {
    const auto ray = on_plane(lens, X_MC, corner.pixel_px);
    const auto at = ray ? found_as(corner, *ray, found, mapping.flat, pattern) : std::nullopt;
    if (at)
      mapping.corners.push_back({.grid_mm = corner.board_mm.head<2>(), .found_mm = *at, .ray_mm = *ray});
  }
  mapping.error = of_one_view(distances(mapping, &PaintedCorner::found_mm, &PaintedCorner::grid_mm));
  mapping.painting = of_one_view(distances(mapping, &PaintedCorner::found_mm, &PaintedCorner::ray_mm));
  return mapping;
}

Result<BoardMappingReport> evaluate_board(const BoardMappingCommand& command,
                                          const MappingProgress& progress) {
  return BoardEvaluator(command, progress).report();
}

}  // namespace orcart
