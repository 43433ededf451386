// Rays against a surface through Embree 3: one static scene of one triangle geometry, built once, asked from
// any thread.
#include "realtime/geometry/ray_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <embree3/rtcore.h>

namespace orcart {

struct RayScene::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

/// Copies the mesh into buffers that Embree owns; false where it has no memory for them.
bool fill_geometry(RTCGeometry geometry, const TriangleMesh& mesh) {
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), mesh.vertices_mm.size());
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(std::uint32_t), mesh.triangles.size());
  if (vertices == nullptr || indices == nullptr) return false;
  std::memcpy(vertices, mesh.vertices_mm.data(), mesh.vertices_mm.size() * sizeof(Eigen::Vector3f));
  std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(std::uint32_t));
  return true;
}

RTCRay make_ray(const Eigen::Vector3f& origin_mm, const Eigen::Vector3f& direction, float near_mm,
                float far_mm) {
  RTCRay ray{};
  ray.org_x = origin_mm.x();
  ray.org_y = origin_mm.y();
  ray.org_z = origin_mm.z();
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tnear = near_mm;
  ray.tfar = far_mm;
  ray.mask = ~0U;
  return ray;
}

/// Embree's own checks end the program for a coordinate that is not a number or beyond 1.8e18; such a ray
/// meets nothing.
bool traceable(const RTCRay& ray) {
  const auto usable = [](float value) { return std::abs(value) <= 1e18F; };
  return usable(ray.org_x) && usable(ray.org_y) && usable(ray.org_z) && usable(ray.dir_x) &&
         usable(ray.dir_y) && usable(ray.dir_z) && usable(ray.tnear) && usable(ray.tfar);
}

constexpr std::size_t kPacket = 8;  ///< neighbours traced together; three times as fast as one by one

/// Traces at most kPacket directions from one origin.
void trace_packet(RTCScene scene, const Eigen::Vector3f& origin_mm,
                  std::span<const Eigen::Vector3f> directions, float far_mm, std::span<RayHit> hits) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit8 query{};
  alignas(32) int valid[kPacket] = {};
  for (std::size_t lane = 0; lane < directions.size(); ++lane) {
    valid[lane] = traceable(make_ray(origin_mm, directions[lane], 0, far_mm)) ? -1 : 0;
    query.ray.org_x[lane] = origin_mm.x();
    query.ray.org_y[lane] = origin_mm.y();
    query.ray.org_z[lane] = origin_mm.z();
    query.ray.dir_x[lane] = directions[lane].x();
    query.ray.dir_y[lane] = directions[lane].y();
    query.ray.dir_z[lane] = directions[lane].z();
    query.ray.tfar[lane] = far_mm;
    query.ray.mask[lane] = ~0U;
    query.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
  }
  rtcIntersect8(valid, scene, &context, &query);
  for (std::size_t lane = 0; lane < directions.size(); ++lane)
    hits[lane] = query.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID
                     ? RayHit{.distance_mm = -1}
                     : RayHit{.distance_mm = query.ray.tfar[lane],
                              .triangle = query.hit.primID[lane],
                              .b1 = query.hit.u[lane],
                              .b2 = query.hit.v[lane]};
}

/// The same question as hidden() for at most kPacket points.
void trace_shadows(RTCScene scene, const Eigen::Vector3f& origin_mm,
                   std::span<const Eigen::Vector3f> points_mm, float margin_mm,
                   std::span<std::uint8_t> hidden) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRay8 query{};
  alignas(32) int valid[kPacket] = {};
  for (std::size_t lane = 0; lane < points_mm.size(); ++lane) {
    const Eigen::Vector3f to_point = points_mm[lane] - origin_mm;
    const float distance_mm = to_point.norm();
    const RTCRay ray = make_ray(origin_mm, to_point / distance_mm, 0, distance_mm - margin_mm);
    valid[lane] = distance_mm > margin_mm && traceable(ray) ? -1 : 0;
    query.org_x[lane] = ray.org_x;
    query.org_y[lane] = ray.org_y;
    query.org_z[lane] = ray.org_z;
    query.dir_x[lane] = ray.dir_x;
    query.dir_y[lane] = ray.dir_y;
    query.dir_z[lane] = ray.dir_z;
    query.tfar[lane] = ray.tfar;
    query.mask[lane] = ~0U;
  }
  rtcOccluded8(valid, scene, &context, &query);
  for (std::size_t lane = 0; lane < points_mm.size(); ++lane)
    hidden[lane] = valid[lane] != 0 && query.tfar[lane] < 0 ? 1 : 0;
}

}  // namespace

RayScene::RayScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::create(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return fail("the surface has no triangles to trace rays against");
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      if (vertex >= mesh.vertices_mm.size())
        return fail("a triangle names vertex " + std::to_string(vertex) + ", but the surface has only " +
                    std::to_string(mesh.vertices_mm.size()));
  auto state = std::make_unique<State>();
  // One thread, no affinity: the build must not start workers beside the real-time threads.
  state->device = rtcNewDevice("verbose=0,threads=1,set_affinity=0");
  if (state->device == nullptr) return fail("Embree could not start on this processor; it needs SSE2");
  state->scene = rtcNewScene(state->device);
  rtcSetSceneFlags(state->scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(state->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const bool filled = fill_geometry(geometry, mesh);
  if (filled) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(state->scene, geometry);
  }
  rtcReleaseGeometry(geometry);
  if (filled) rtcCommitScene(state->scene);
  if (!filled || rtcGetDeviceError(state->device) != RTC_ERROR_NONE)
    return fail("Embree could not build a ray tree over " + std::to_string(mesh.triangles.size()) +
                " triangles; give it more memory or a coarser surface");
  return RayScene(std::move(state));
}

std::optional<RayHit> RayScene::nearest(const Eigen::Vector3f& origin_mm, const Eigen::Vector3f& direction,
                                        float far_mm, float near_mm) const noexcept {
  RTCRayHit query{.ray = make_ray(origin_mm, direction, near_mm, far_mm), .hit = {}};
  if (!traceable(query.ray)) return std::nullopt;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(state_->scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return RayHit{
      .distance_mm = query.ray.tfar, .triangle = query.hit.primID, .b1 = query.hit.u, .b2 = query.hit.v};
}

bool RayScene::hidden(const Eigen::Vector3f& origin_mm, const Eigen::Vector3f& point_mm,
                      float margin_mm) const noexcept {
  const Eigen::Vector3f to_point = point_mm - origin_mm;
  const float distance_mm = to_point.norm();
  if (!(distance_mm > margin_mm)) return false;
  RTCRay ray = make_ray(origin_mm, to_point / distance_mm, 0, distance_mm - margin_mm);
  if (!traceable(ray)) return false;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(state_->scene, &context, &ray);
  return ray.tfar < 0;  // Embree's word for "occluded" is minus infinity
}

void RayScene::hidden_many(const Eigen::Vector3f& origin_mm, std::span<const Eigen::Vector3f> points_mm,
                           float margin_mm, std::span<std::uint8_t> hidden) const noexcept {
  const std::size_t count = std::min(points_mm.size(), hidden.size());
  for (std::size_t first = 0; first < count; first += kPacket)
    trace_shadows(state_->scene, origin_mm, points_mm.subspan(first, std::min(kPacket, count - first)),
                  margin_mm, hidden.subspan(first));
}

void RayScene::nearest_many(const Eigen::Vector3f& origin_mm, std::span<const Eigen::Vector3f> directions,
                            float far_mm, std::span<RayHit> hits) const noexcept {
  const std::size_t count = std::min(directions.size(), hits.size());
  for (std::size_t first = 0; first < count; first += kPacket)
    trace_packet(state_->scene, origin_mm, directions.subspan(first, std::min(kPacket, count - first)),
                 far_mm, hits.subspan(first));
}

}  // namespace orcart
