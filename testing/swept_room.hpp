// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/mapping/plane_map.hpp"

// For tests of the window: a room of planes, as points and as a map.
namespace dynamic_icp::window {

/// The inner faces of a box, or of a tunnel along x: a box without its ends.
struct Room {
  Eigen::Vector3d half{11.1, 7.1, 3.1};  ///< m
  bool has_ends = true;
  double noise_m = 0.005;
  double patch_sigma_m = 0.0;  ///< of the height of each piece of wall of 2 m

  [[nodiscard]] std::vector<Eigen::Vector3d> points(unsigned seed, std::size_t count) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::normal_distribution<double> normal;
    std::map<std::vector<int>, double> heights;
    std::vector<Eigen::Vector3d> result;
    while (result.size() < count) {
      Eigen::Vector3d point;
      // One after the other: the order of the arguments of a call is open.
      for (int axis = 0; axis < 3; ++axis) {
        point[axis] = half[axis] * uniform(random);
      }
      const int face = static_cast<int>(result.size() % (has_ends ? 6 : 4));
      const int axis = 2 - face / 2;
      point[axis] = (face % 2 == 0 ? 1.0 : -1.0) * half[axis];
      const Eigen::Vector3i cell = (0.5 * point).array().floor().cast<int>();
      const auto [height, is_new] = heights.try_emplace({cell.x(), cell.y(), cell.z(), face}, 0.0);
      if (is_new) {
        height->second = patch_sigma_m * normal(random);
      }
      point[axis] += height->second + noise_m * normal(random);
      result.push_back(point);
    }
    return result;
  }

  /// Each point measured at some phase of the sweep.
  [[nodiscard]] mapping::PlaneMap map(std::size_t count = 40000) const {
    const std::vector<Eigen::Vector3d> all = points(1, count);
    std::vector<double> phases;
    for (const Eigen::Vector3d& point : all) {
      phases.push_back(0.5 + 0.4 * std::sin(0.2 * point.x() + 0.3 * point.y()));
    }
    mapping::PlaneMap result({});
    result.add(all, Eigen::Vector3d::Zero(), Workers(1), phases);
    return result;
  }
};

}  // namespace dynamic_icp::window
