// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/spatial/kd_tree.hpp"

namespace dynamic_icp::preprocess {

struct NormalsConfig {
  double radius_m = 2.0;
  int max_neighbours = 30;  ///< the point itself counts
};

ConfigFields fields(NormalsConfig& config);

/// Surface normals of a cloud. Points whose neighbourhood is no plane have none: that is a mark, never a guess.
struct Normals {
  std::vector<Eigen::Vector3d> vectors;  ///< unit length; zero where there is none. The sign is arbitrary
  std::vector<std::uint8_t> valid;       ///< 1 where there is a normal

  [[nodiscard]] bool has(std::size_t i) const { return valid[i] != 0; }
  [[nodiscard]] std::size_t count() const;
};

/// Fits a plane to each point's nearest neighbours: at most `max_neighbours` within `radius_m`, the point itself
/// included. The normal is the direction of smallest scatter. Fewer than three neighbours, or neighbours on a line,
/// make no plane.
Normals estimate_normals(std::span<const Eigen::Vector3d> points, const spatial::KdTree& tree,
                         const NormalsConfig& config, const Workers& workers);

}  // namespace dynamic_icp::preprocess
