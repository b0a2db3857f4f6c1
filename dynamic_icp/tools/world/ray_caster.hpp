// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/tools/world/world.hpp"

namespace dynamic_icp::world {

/// A half line from the sensor.
struct Ray {
  Eigen::Vector3d origin_world;
  Eigen::Vector3d direction_world;  ///< unit length
  double max_range_m = 0.0;
};

/// Where a ray first meets a surface.
struct RayHit {
  double range_m = 0.0;
  Eigen::Vector3d normal_world;     ///< outward unit normal of the surface
  double reflectivity = 0.0;        ///< of the surface, see TriangleMesh
  std::optional<std::size_t> body;  ///< index into World::bodies; empty on the static surface
  bool foliage = false;             ///< whether wind moves the surface
};

/// Casts rays into a world with Embree. The static surface and each shape get a search tree once; a ray meets a moving
/// body in the body's own frame, so every ray may have its own time and nothing is rebuilt when bodies move.
///
/// Embree computes in single precision. It only decides which triangle is met; the range is computed again in double
/// precision from that triangle's plane, so points lie on the surfaces to about 1e-12 m.
class RayCaster {
 public:
  /// Keeps a reference to `world`, which must outlive the caster. Throws DataError when Embree cannot be set up.
  explicit RayCaster(const World& world);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;

  /// The nearest surface within the ray's range, with the bodies as they are at the ray's time (`bodies_at`).
  /// May be called from several threads at once.
  [[nodiscard]] std::optional<RayHit> cast(const Ray& ray, std::span<const BodyAt> bodies) const;

 private:
  class SearchTree;

  const World* world_;
  std::unique_ptr<SearchTree> statics_;
  std::vector<std::unique_ptr<SearchTree>> shapes_;
};

}  // namespace dynamic_icp::world
