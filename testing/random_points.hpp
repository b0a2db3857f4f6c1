// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include <Eigen/Core>

// Random sets of points for the tests of the clustering.
namespace dynamic_icp::dynamics {

using Points = std::vector<Eigen::Vector3d>;

inline double uniform(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Eigen::Vector3d gaussian(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const double x = normal(random);
  const double y = normal(random);
  return {x, y, normal(random)};
}

inline Eigen::Vector3d in_cube(std::mt19937& random, double half_width_m) {
  const double x = uniform(random, -half_width_m, half_width_m);
  const double y = uniform(random, -half_width_m, half_width_m);
  return {x, y, uniform(random, -half_width_m, half_width_m)};
}

/// One to five blobs of different density, some noise.
inline Points blobs(std::mt19937& random, std::size_t n) {
  Points centres;
  std::vector<double> sigmas;
  for (std::size_t c = 0; c <= random() % 5; ++c) {
    centres.push_back(in_cube(random, 6.0));
    sigmas.push_back(uniform(random, 0.1, 1.5));
  }
  Points points;
  while (points.size() < n) {
    const std::size_t c = random() % centres.size();
    points.push_back(random() % 8 == 0 ? in_cube(random, 8.0)
                                       : Eigen::Vector3d(centres[c] + sigmas[c] * gaussian(random)));
  }
  return points;
}

inline Points lines(std::mt19937& random, std::size_t n) {
  const Points ends{in_cube(random, 5.0), in_cube(random, 5.0), in_cube(random, 5.0), in_cube(random, 5.0)};
  Points points;
  while (points.size() < n) {
    const std::size_t line = 2 * (random() % 2);
    const double s = uniform(random, 0.0, 1.0);
    points.emplace_back(s * ends[line] + (1.0 - s) * ends[line + 1]);
  }
  return points;
}

inline Points with_duplicates(std::mt19937& random, std::size_t n) {
  Points points = blobs(random, n / 2);
  while (points.size() < n) {
    points.push_back(points[random() % (points.size() / 4)]);
  }
  return points;
}

inline Points flat(Points points) {
  for (Eigen::Vector3d& p : points) {
    p.z() = 0.0;
  }
  return points;
}

}  // namespace dynamic_icp::dynamics
