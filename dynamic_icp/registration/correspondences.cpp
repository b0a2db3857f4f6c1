// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/registration/correspondences.hpp"

#include <cmath>
#include <optional>

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kBlock = 512;

}  // namespace

Correspondences find_correspondences(const Scan& source, const Target& target, const Eigen::Isometry3d& T_target_source,
                                     double max_distance_m, const Workers& workers) {
  std::vector<std::optional<spatial::Neighbour>> nearest(source.size());
  workers.for_each(source.size(), kBlock, [&](std::size_t i) {
    nearest[i] = target.tree.nearest(T_target_source * source.points()[i], max_distance_m);
  });
  Correspondences result;
  result.pairs.reserve(source.size());
  double sum = 0.0;
  for (std::uint32_t i = 0; i < source.size(); ++i) {
    if (nearest[i] && target.has_normal[nearest[i]->index] != 0) {
      result.pairs.push_back({i, nearest[i]->index, nearest[i]->squared_distance});
      sum += nearest[i]->squared_distance;
    }
  }
  if (!result.pairs.empty()) {
    const auto count = static_cast<double>(result.pairs.size());
    result.fitness = count / static_cast<double>(source.size());
    result.inlier_rmse = std::sqrt(sum / count);
  }
  return result;
}

}  // namespace dynamic_icp::registration
