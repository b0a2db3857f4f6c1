// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/world/drive.hpp"
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

namespace dynamic_icp::world {

/// Rolling ground: a sum of plane sine waves, so that height, slope and bend are known in closed form everywhere.
class Terrain {
 public:
  /// Waves from 45 m down to 11 m long; `roughness` scales their heights (1: slopes up to about 10 deg).
  Terrain(double roughness, const RandomSource& random);

  [[nodiscard]] double height_m(const Eigen::Vector2d& position) const;

  /// How a vehicle that follows the ground sways: its height is that of the ground below its middle, its forward and
  /// left axes have the slopes there. The rates are exact.
  [[nodiscard]] Sway sway(const PlanarState& planar) const;

  /// The ground between two corners (m) in square cells, each vertex raised or lowered by up to `grain_m`.
  [[nodiscard]] TriangleMesh mesh(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double cell_m,
                                  double grain_m, const RandomSource& random) const;

 private:
  struct Wave {
    double amplitude = 0.0;  // m
    Eigen::Vector2d k;       // rad/m
    double phase = 0.0;
  };

  std::vector<Wave> waves_;
};

}  // namespace dynamic_icp::world
