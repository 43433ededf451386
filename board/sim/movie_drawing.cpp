// The drawing of a movie: exposure gains first, in order, because they adapt; then frames in any order.
#include "board/sim/movie_drawing.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "board/sim/fingerprint.hpp"

namespace orcart {
namespace {

constexpr int kFewestBlurSamples = 3, kMostBlurSamples = 5;
constexpr double kBlurStep_mm = 0.06;    ///< of the tip's way between two samples of one exposure
constexpr double kGainEvery_s = 0.1;     ///< how often the automatic exposure looks
constexpr double kGainSettles_s = 0.45;  ///< its time constant
constexpr Nanos kProgressEvery = 200ms;

void add_lens(Fingerprint& print, const ScopeModel& scope) {
  const Lens& lens = scope.lens;
  print.add(lens.model).add(scope.width_px).add(scope.height_px);
  for (const double number :
       {lens.fx_px, lens.fy_px, lens.cx_px, lens.cy_px, lens.distortion_centre_px.x(),
        lens.distortion_centre_px.y(), lens.max_angle_rad, scope.mask.cx_px, scope.mask.cy_px,
        scope.mask.radius_px, scope.fall_off.vignetting_cos_power, scope.cone_half_angle_rad})
    print.add(number);
  for (const double coefficient : lens.coefficients) print.add(coefficient);
  if (scope.notch_rad) print.add(*scope.notch_rad);
  if (scope.turning) print.add(scope.turning->centre_px.x()).add(scope.turning->centre_px.y());
}

std::uint64_t content_of(const MovieRequest& request) {
  Fingerprint print;
  print.add(fingerprint(request.world.script())).add_bytes(request.surface.identity.hash);
  print.add(request.surface.mesh.vertices_mm.size()).add(request.surface.mesh.triangles.size());
  add_lens(print, request.scope);
  const SceneLook& look = request.look;
  print.add(look.lighting)
      .add(look.specular)
      .add(look.noise)
      .add(look.blur)
      .add(look.tissue.index())
      .add(look.texel_mm);
  if (const auto* living = std::get_if<LivingTissue>(&look.tissue)) print.add(living->seed).add(living->kind);
  if (const auto* code = std::get_if<CodedTissue>(&look.tissue))
    print.add(code->axis).add(code->period_mm).add(code->phase_rad);
  return print.value();
}

Pose<M, C> pose_at(const MovieRequest& request, Nanos since_start) {
  return request.world.X_MC(request.world.start() + since_start);
}

/// The automatic exposure: looks every kGainEvery_s and follows slowly (first order, in the logarithm).
class GainCurve {
 public:
  GainCurve(const MovieRequest& request, const ScopeCamera& camera) {
    ScopeCamera::Scratch scratch;
    const double share = 1 - std::exp(-kGainEvery_s / kGainSettles_s);
    const int looks = 2 + static_cast<int>(request.world.script().duration_s / kGainEvery_s);
    for (int i = 0; i < looks; ++i) {
      const double wanted =
          std::log(camera.fitting_gain(pose_at(request, from_seconds(i * kGainEvery_s)), scratch));
      logarithms_.push_back(i == 0 ? wanted : logarithms_.back() + share * (wanted - logarithms_.back()));
    }
  }
  float at(Nanos since_start) const {
    const double place =
        std::clamp(seconds(since_start) / kGainEvery_s, 0.0, static_cast<double>(logarithms_.size() - 2));
    const auto i = static_cast<std::size_t>(place);
    return static_cast<float>(
        std::exp(std::lerp(logarithms_[i], logarithms_[i + 1], place - std::floor(place))));
  }

 private:
  std::vector<double> logarithms_;
};

std::vector<Pose<M, C>> poses_during(const MovieRequest& request, std::uint64_t frame) {
  const bool blurred =
      request.look.blur == Effect::on && std::holds_alternative<LivingTissue>(request.look.tissue);
  const double way_mm = (pose_at(request, request.timing.end_of(frame)).translation_mm -
                         pose_at(request, request.timing.start_of(frame)).translation_mm)
                            .norm();
  const int needed = 1 + static_cast<int>(way_mm / kBlurStep_mm);
  const int count = blurred ? std::clamp(needed, kFewestBlurSamples, kMostBlurSamples) : 1;
  std::vector<Pose<M, C>> poses;
  for (int i = 0; i < count; ++i)  // at the middles of `count` equal parts
    poses.push_back(pose_at(
        request, request.timing.start_of(frame) + (2 * i + 1) * request.timing.exposure / (2 * count)));
  return poses;
}

void draw_into(const MovieRequest& request, const ScopeCamera& camera, std::uint64_t frame, float gain,
               ScopeCamera::Scratch& scratch, std::span<std::byte> pixels) {
  const auto poses = poses_during(request, frame);
  camera.draw({.frame = frame + request.world.script().seed * 1'000'003,
               .poses = poses,
               .gain = gain,
               .turn_rad = request.world.turn_rad(request.world.start() + request.timing.middle_of(frame))},
              scratch,
              packed_image(pixels.data(), request.format, request.scope.width_px, request.scope.height_px));
}

MovieFrame record_of(const MovieRequest& request, std::uint64_t frame) {
  MovieFrame record{.exposure_start_ns = request.timing.start_of(frame).count(),
                    .exposure_end_ns = request.timing.end_of(frame).count()};
  const Pose<M, C> X_MC = pose_at(request, request.timing.middle_of(frame));
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) record.X_MC[static_cast<std::size_t>(4 * r + c)] = X_MC.rotation(r, c);
    record.X_MC[static_cast<std::size_t>(4 * r + 3)] = X_MC.translation_mm[r];
  }
  return record;
}

/// What the drawing threads share.
struct Drawing {
  const MovieRequest& request;
  const ScopeCamera& camera;
  const GainCurve& gains;
  MovieWriter& writer;
  std::uint64_t frames = 0;
  std::atomic<std::uint64_t> next{0}, drawn{0};
  std::atomic<bool> failed{false};
};

void draw_frames(Drawing& drawing) {
  ScopeCamera::Scratch scratch;
  const MovieRequest& request = drawing.request;
  std::vector<std::byte> pixels(
      packed_bytes(request.format, request.scope.width_px, request.scope.height_px));
  for (std::uint64_t k = drawing.next.fetch_add(1, std::memory_order_relaxed);  // a ticket, orders nothing
       k < drawing.frames && !drawing.failed.load(std::memory_order_relaxed);
       k = drawing.next.fetch_add(1, std::memory_order_relaxed)) {
    draw_into(request, drawing.camera, k, drawing.gains.at(request.timing.middle_of(k)), scratch, pixels);
    if (!drawing.writer.put(k, record_of(request, k), pixels))
      drawing.failed.store(true, std::memory_order_relaxed);
    drawing.drawn.fetch_add(1, std::memory_order_relaxed);  // for the progress alone; join() orders the rest
  }
}

void draw_all(Drawing& drawing, const DrawingProgress& progress) {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const unsigned count = drawing.request.threads > 0 ? static_cast<unsigned>(drawing.request.threads) : cores;
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < count; ++i) threads.emplace_back([&drawing] { draw_frames(drawing); });
  const auto drawn = [&] { return drawing.drawn.load(std::memory_order_relaxed); };
  while (progress && drawn() < drawing.frames && !drawing.failed.load(std::memory_order_relaxed)) {
    progress(drawn(), drawing.frames);
    std::this_thread::sleep_for(kProgressEvery);
  }
  threads.clear();
  if (progress) progress(drawn(), drawing.frames);
}

}  // namespace

MovieHeader header_for(const MovieRequest& request) {
  const double usable_s =
      request.world.script().duration_s - seconds(request.timing.first + request.timing.exposure);
  const auto frames =
      static_cast<std::uint32_t>(std::max(0.0, std::floor(usable_s * request.timing.rate_hz) + 1));
  return {.width_px = request.scope.width_px,
          .height_px = request.scope.height_px,
          .format = request.format,
          .frame_count = frames,
          .rate_hz = request.timing.rate_hz,
          .exposure_ns = request.timing.exposure.count(),
          .first_ns = request.timing.first.count(),
          .seed = request.world.script().seed,
          .content = content_of(request)};
}

Result<MovieFile> movie_for(const std::filesystem::path& file, const MovieRequest& request,
                            const DrawingProgress& progress) {
  const MovieHeader header = header_for(request);
  if (auto there = MovieFile::open(file); there && there->header() == header) return there;
  auto writer = MovieWriter::create(file, header);
  if (!writer) return tl::unexpected(writer.error());
  const ScopeCamera camera(request.surface.mesh, request.rays, request.scope, request.look);
  const GainCurve gains(request, camera);
  Drawing drawing{
      .request = request, .camera = camera, .gains = gains, .writer = *writer, .frames = header.frame_count};
  draw_all(drawing, progress);
  if (drawing.failed.load(std::memory_order_relaxed))
    return fail(file.string() + " could not be written; is the disk full?");
  if (auto done = writer->finish(); !done) return tl::unexpected(done.error());
  return MovieFile::open(file);
}

std::vector<std::byte> draw_frame(const MovieRequest& request, const ScopeCamera& camera,
                                  std::uint64_t frame) {
  ScopeCamera::Scratch scratch;
  std::vector<std::byte> pixels(
      packed_bytes(request.format, request.scope.width_px, request.scope.height_px));
  const float gain = camera.fitting_gain(pose_at(request, request.timing.middle_of(frame)), scratch);
  draw_into(request, camera, frame, gain, scratch, pixels);
  return pixels;
}

}  // namespace orcart
