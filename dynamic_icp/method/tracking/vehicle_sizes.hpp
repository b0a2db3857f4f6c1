// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/size_prior.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// How much of a vehicle was seen along one of its axes.
struct SeenSize {
  double m = 0.0;
  bool is_whole = false;  ///< from end to end; else there may be more of it
};

/// Sizes of vehicles that were seen from end to end. Others resemble them.
///
/// The logarithms x of length, width and height are draws from an unknown distribution with a Dirichlet process as
/// prior, whose base is flat. What the vehicles x_i predict of the next one is
///   p(x) = (1 + sum_i N(x - x_i; 0, S)) / (1 + n),
/// and of one that was seen in part the rest follows from p(x | seen).
class VehicleSizes {
 public:
  /// Length, width and height of a vehicle, m; what was said of it before is forgotten. Not of what is no vehicle, as
  /// flat things are.
  void note(std::int64_t id, const Eigen::Vector3d& size_m);

  /// Length, width and height of a vehicle of which so much was seen: the medians, and the mean squares of the
  /// differences from them. `otherwise`: what is likely if it resembles none.
  [[nodiscard]] std::array<Belief, 3> complete(const std::array<SeenSize, 3>& seen,
                                               const std::array<Belief, 3>& otherwise) const;

  void state(StateArchive& archive);

 private:
  struct Vehicle {
    std::int64_t id = 0;
    Eigen::Vector3d log_size = Eigen::Vector3d::Zero();
  };

  static constexpr std::size_t kMemory = 64;  // the last ones

  std::vector<Vehicle> vehicles_;
  std::size_t next_ = 0;
};

}  // namespace dynamic_icp::tracking
