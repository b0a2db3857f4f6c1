// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/registration/correspondences.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace dynamic_icp::registration {
namespace {

constexpr std::size_t kBlock = 512;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Points are looked up a little beyond the gate, so that those without a partner need no new search at every step.
constexpr double kReachOverGate = 1.25;

// Far more than the rounding of the distances compared, far less than any distance that matters.
constexpr double kRounding_m = 1e-9;

}  // namespace

Correspondences judged(std::vector<Correspondence> pairs, std::size_t source_size) {
  Correspondences result;
  result.pairs = std::move(pairs);
  double sum = 0.0;
  for (const Correspondence& pair : result.pairs) {
    sum += pair.squared_distance;
  }
  if (!result.pairs.empty()) {
    const auto count = static_cast<double>(result.pairs.size());
    result.fitness = count / static_cast<double>(source_size);
    result.inlier_rmse = std::sqrt(sum / count);
  }
  return result;
}

CorrespondenceSearch::CorrespondenceSearch(const Scan& source, const Target& target, double max_distance_m,
                                           bool needs_normals, const Workers& workers)
    : source_(source),
      target_(target),
      max_distance_m_(max_distance_m),
      needs_normals_(needs_normals),
      workers_(workers),
      known_(source.size()) {}

bool CorrespondenceSearch::still_known(std::size_t i, const Eigen::Vector3d& point) const {
  const Known& known = known_[i];
  if (known.others < 0.0) {
    return false;
  }
  const double moved = (point - known.at).norm() + kRounding_m;
  // The nearest one is now at most distance + moved away, all others at least others - moved.
  const double reach = known.nearest == kNone ? max_distance_m_ : known.distance + moved;
  return reach < known.others - moved;
}

void CorrespondenceSearch::look_up(std::size_t i, const Eigen::Vector3d& point,
                                   std::vector<spatial::Neighbour>& found) {
  const double reach = kReachOverGate * max_distance_m_;
  target_.tree.nearest_k(point, 2, reach, found);
  Known& known = known_[i];
  known.at = point;
  known.nearest = found.empty() ? kNone : found[0].index;
  known.distance = found.empty() ? reach : std::sqrt(found[0].squared_distance);
  known.others = found.size() < 2 ? reach : std::sqrt(found[1].squared_distance);
}

Correspondences CorrespondenceSearch::find(const Eigen::Isometry3d& T_target_source) {
  const double gate = max_distance_m_ * max_distance_m_;
  std::vector<double> squared(source_.size(), -1.0);
  workers_.for_blocks(source_.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> found;
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d point = T_target_source * source_.points()[i];
      if (!still_known(i, point)) {
        look_up(i, point, found);
      }
      const std::uint32_t j = known_[i].nearest;
      if (j != kNone && (!needs_normals_ || target_.has_normal[j] != 0)) {
        squared[i] = spatial::squared_distance(point, target_.scan.points()[j]);
      }
    }
  });
  std::vector<Correspondence> pairs;
  pairs.reserve(source_.size());
  for (std::uint32_t i = 0; i < source_.size(); ++i) {
    if (squared[i] >= 0.0 && squared[i] <= gate) {
      pairs.push_back({i, known_[i].nearest, squared[i]});
    }
  }
  return judged(std::move(pairs), source_.size());
}

}  // namespace dynamic_icp::registration
