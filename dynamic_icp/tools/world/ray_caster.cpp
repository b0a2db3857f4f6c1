// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/ray_caster.hpp"

#include <cmath>
#include <limits>
#include <string>

#if DYNAMIC_ICP_EMBREE_VERSION >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::world {
namespace {

struct TriangleHit {
  double range_m = 0.0;
  std::size_t triangle = 0;
};

/// The only call whose form differs between Embree 3 and 4.
void intersect(RTCScene scene, RTCRayHit& query) {
#if DYNAMIC_ICP_EMBREE_VERSION >= 4
  rtcIntersect1(scene, &query, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
#endif
}

RTCRayHit make_query(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double max_range_m) {
  RTCRayHit query{};
  const Eigen::Vector3f from = origin.cast<float>();
  const Eigen::Vector3f along = direction.cast<float>();
  query.ray.org_x = from.x();
  query.ray.org_y = from.y();
  query.ray.org_z = from.z();
  query.ray.dir_x = along.x();
  query.ray.dir_y = along.y();
  query.ray.dir_z = along.z();
  query.ray.tnear = 0.0F;
  query.ray.tfar = static_cast<float>(max_range_m);
  query.ray.mask = std::numeric_limits<unsigned>::max();
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.primID = RTC_INVALID_GEOMETRY_ID;
  for (unsigned& instance : query.hit.instID) {
    instance = RTC_INVALID_GEOMETRY_ID;
  }
  return query;
}

/// Whether the ray passes the ball nearer than its maximum range.
bool meets_ball(const Ray& ray, const BodyAt& body) {
  const Eigen::Vector3d to_center = body.ball_center_world - ray.origin_world;
  const double along = to_center.dot(ray.direction_world);
  const double radius_squared = body.ball_radius_m * body.ball_radius_m;
  const double distance_squared = to_center.squaredNorm();
  return along > -body.ball_radius_m && along - body.ball_radius_m < ray.max_range_m &&
         distance_squared - along * along <= radius_squared;
}

const char* reason_of(RTCError error) {
  switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return "the machine has no memory left";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "it does not support this processor";
    default:
      return "without giving a reason";
  }
}

}  // namespace

/// Embree's search tree over one mesh.
class RayCaster::SearchTree {
 public:
  SearchTree(RTCDevice device, const TriangleMesh& mesh) : mesh_(&mesh), scene_(rtcNewScene(device)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    attach_triangles(device);
    rtcCommitScene(scene_);
    if (const RTCError fault = rtcGetDeviceError(device); fault != RTC_ERROR_NONE) {
      throw DataError("Embree cannot build a search tree over " + std::to_string(mesh.triangles.size()) +
                      " triangles: " + reason_of(fault));
    }
  }

  ~SearchTree() { rtcReleaseScene(scene_); }

  SearchTree(const SearchTree&) = delete;
  SearchTree& operator=(const SearchTree&) = delete;

  /// The nearest triangle along a ray in the mesh's frame.
  [[nodiscard]] std::optional<TriangleHit> nearest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                                   double max_range_m) const {
    RTCRayHit query = make_query(origin, direction, max_range_m);
    intersect(scene_, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      return std::nullopt;
    }
    const Eigen::Vector3d normal = triangle_normal(*mesh_, query.hit.primID);
    const Eigen::Vector3d& corner = mesh_->vertices[mesh_->triangles[query.hit.primID][0]];
    const double range = normal.dot(corner - origin) / normal.dot(direction);
    // A ray within a plane has no range to it.
    if (!(range > 0.0 && range <= max_range_m)) {
      return std::nullopt;
    }
    return TriangleHit{range, query.hit.primID};
  }

  [[nodiscard]] Eigen::Vector3d normal(std::size_t triangle) const { return triangle_normal(*mesh_, triangle); }
  [[nodiscard]] double reflectivity(std::size_t triangle) const { return mesh_->reflectivity[triangle]; }
  [[nodiscard]] bool foliage(std::size_t triangle) const { return !mesh_->foliage.empty() && mesh_->foliage[triangle]; }

 private:
  void attach_triangles(RTCDevice device) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh_->vertices.size()));
    auto* triangles = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), mesh_->triangles.size()));
    if (vertices != nullptr && triangles != nullptr) {
      for (const Eigen::Vector3d& vertex : mesh_->vertices) {
        Eigen::Map<Eigen::Vector3f>{vertices} = vertex.cast<float>();
        vertices += 3;
      }
      for (const auto& corners : mesh_->triangles) {
        triangles = std::copy(corners.begin(), corners.end(), triangles);
      }
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
    }
    rtcReleaseGeometry(geometry);
  }

  const TriangleMesh* mesh_;
  RTCScene scene_;
};

RayCaster::RayCaster(const World& world) : world_(&world) {
  // One thread builds the trees: where two triangles are met at the same distance, the shape of the tree decides which
  // one is reported, and it must be the same tree each time.
  const RTCDevice device = rtcNewDevice("threads=1");
  if (device == nullptr) {
    throw DataError(std::string("the search for what rays meet (Embree) cannot start: ") +
                    reason_of(rtcGetDeviceError(nullptr)));
  }
  const std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> owner(device,
                                                                rtcReleaseDevice);  // scenes keep their own hold
  statics_ = std::make_unique<SearchTree>(device, world.statics);
  for (const Shape& shape : world.shapes) {
    shapes_.push_back(std::make_unique<SearchTree>(device, shape.mesh));
  }
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<RayHit> RayCaster::cast(const Ray& ray, std::span<const BodyAt> bodies) const {
  std::optional<RayHit> nearest;
  Ray rest = ray;
  if (const auto hit = statics_->nearest(ray.origin_world, ray.direction_world, ray.max_range_m)) {
    nearest = RayHit{hit->range_m, statics_->normal(hit->triangle), statics_->reflectivity(hit->triangle), std::nullopt,
                     statics_->foliage(hit->triangle)};
    rest.max_range_m = hit->range_m;
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!meets_ball(rest, bodies[i])) {
      continue;
    }
    const SearchTree& shape = *shapes_[world_->bodies[i].shape];
    const Eigen::Isometry3d& T_world_body = bodies[i].motion.T_world_body;
    const Eigen::Isometry3d T_body_world = T_world_body.inverse();
    if (const auto hit = shape.nearest(T_body_world * ray.origin_world, T_body_world.linear() * ray.direction_world,
                                       rest.max_range_m)) {
      nearest = RayHit{hit->range_m, T_world_body.linear() * shape.normal(hit->triangle),
                       shape.reflectivity(hit->triangle), i, shape.foliage(hit->triangle)};
      rest.max_range_m = hit->range_m;
    }
  }
  return nearest;
}

}  // namespace dynamic_icp::world
