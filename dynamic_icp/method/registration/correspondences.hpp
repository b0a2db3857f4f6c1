// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/registration/source_rows.hpp"
#include "dynamic_icp/method/registration/target.hpp"
#include "dynamic_icp/method/spatial/few_nearest.hpp"

namespace dynamic_icp::registration {

struct Correspondence {
  std::uint32_t source;     ///< row of the source scan
  std::uint32_t target;     ///< row of the target scan
  double squared_distance;  ///< m^2, between T p_i and q_j
};

/// Association, apart from what is done with it: data that can be printed, tested and drawn.
struct Correspondences {
  std::vector<Correspondence> pairs;  ///< in the order of the source rows
  double fitness = 0.0;               ///< share of the source points that found a partner
  double inlier_rmse = 0.0;           ///< m, root mean square distance of the pairs; 0 without pairs
};

/// How well correspondences fit, without them.
struct Fit {
  std::size_t pairs = 0;
  double fitness = 0.0;
  double inlier_rmse = 0.0;  ///< m
};

/// Of so many pairs whose squared distances add up to `squared_distances` (m^2).
Fit fit_of(std::size_t pairs, double squared_distances, std::size_t source_size);

/// Pairs in the order of the source rows, with their fitness and inlier RMSE.
Correspondences evaluated(std::vector<Correspondence> pairs, std::size_t source_size);

/// How far a target point may be from a source point that it is paired with: `max_distance_m`, and for a source point
/// at a distance d from the sensor `per_range` d more.
struct Gate {
  double max_distance_m = 0.3;
  double per_range = 0.0;

  [[nodiscard]] double at(const Eigen::Vector3d& source_point) const {
    return max_distance_m + (per_range > 0.0 ? per_range * source_point.norm() : 0.0);
  }
};

/// Pairs each source point, moved by T_target_source, with the nearest target point within the gate.
/// A source point whose nearest target point has no normal stays alone: it gets no second choice.
///
/// The search is exact and remembers: for each point it knows where it was last looked up, which few target points were
/// nearest and how far all others were at least. While the point has not moved so far that another one of the few could
/// have come nearer, its partner is the same; while none of the others could, it is one of the few; only then the tree
/// is searched again. The result does not depend on the poses asked for before.
class CorrespondenceSearch {
 public:
  /// The scans must outlive the search.
  /// With `needs_normals`, pairs whose target point has no usable normal are left out.
  CorrespondenceSearch(const Scan& source, const Target& target, const Gate& gate, bool needs_normals,
                       const Workers& workers);

  Correspondences find(const Eigen::Isometry3d& T_target_source);

  /// The same for some of the rows, for who continues with them directly: moves groups [begin, end) to a pose and
  /// brings their partners up to date. Different groups may be located at the same time.
  void locate(const Eigen::Isometry3d& T_target_source, std::size_t begin, std::size_t end);
  /// The source, four points a group, neighbours near each other.
  [[nodiscard]] const std::vector<SourceRows>& groups() const { return groups_; }
  /// The pairs at the pose that all groups were located at last.
  [[nodiscard]] Correspondences pairs() const;

 private:
  /// The nearest target points of a point when the tree was searched.
  struct NeighbourCache {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< m, target frame: where the point was
    double others = 0.0;                           ///< m, all other target points were at least so far away from there
    std::array<std::uint32_t, spatial::FewNearest::kCapacity> nearest{};
    std::uint32_t count = 0;  ///< of those, the first ones
  };

  void look_up(std::span<const std::uint32_t> places);
  bool choose_among_known(std::uint32_t place);
  void search(std::span<const std::uint32_t> places);
  void remember(std::uint32_t place, const Eigen::Vector3d& point, const spatial::Neighbour* nearest, double others);

  const Scan& source_;
  Target target_;
  std::vector<double> gate_m_;  ///< by place
  double widest_gate_m_;
  bool needs_normals_;
  const Workers& workers_;
  std::vector<std::uint32_t> place_of_;  ///< by row of the source: its place in the groups, four to a group
  std::vector<SourceRows> groups_;
  unsigned lanes_of_last_group_;       ///< a bit for each lane of the last group that holds a point
  std::vector<NeighbourCache> cache_;  ///< by place
};

}  // namespace dynamic_icp::registration
