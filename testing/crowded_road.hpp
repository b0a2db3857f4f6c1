// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"

namespace dynamic_icp::ego_motion {

/// A scene from equations: a road between far walls, and boxes around the sensor that move with one velocity.
struct Scene {
  Eigen::Vector3d v{8.0, 0.3, -0.2};                // of the sensor
  Eigen::Vector3d a = Eigen::Vector3d::Zero();      // its change, m/s^2
  Eigen::Vector3d dynamic_outliers{3.0, 0.0, 0.0};  // velocity of the boxes over ground
  double dynamic_share = 0.0;                       // of the points
  double bias = 0.0;
  double noise = 0.05;
  double outlier_share = 0.005;
  double half_width = 1.05;  // of the field of view, rad
  double half_height = 0.17;
  double sweep_s = 0.0;  // from right to left
  std::size_t points = 8000;
};

class Caster {
 public:
  Caster(const Scene& scene, unsigned seed) : scene_(scene), random_(seed) {}

  Scan scan() {
    RawScan raw;
    const auto dynamic_outliers = static_cast<std::size_t>(scene_.dynamic_share * static_cast<double>(scene_.points));
    for (std::size_t i = 0; i < scene_.points; ++i) {
      add(raw, i < dynamic_outliers ? box_point() : world_point(), i < dynamic_outliers);
    }
    return Scan::from_raw(raw);
  }

 private:
  double uniform(double low, double high) { return low + (high - low) * uniform_(random_); }

  Eigen::Vector3d direction() {
    const double azimuth = uniform(-scene_.half_width, scene_.half_width);
    const double elevation = uniform(-scene_.half_height, scene_.half_height);
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
  }

  // The nearest of ground (z = -1.8 m), walls (y = -25 m, y = 25 m) and a wall ahead (x = 80 m).
  Eigen::Vector3d world_point() {
    const Eigen::Vector3d u = direction();
    double range = 80.0 / std::max(1e-3, u.x());
    range = std::min(range, 25.0 / std::max(1e-3, std::abs(u.y())));
    range = u.z() < 0.0 ? std::min(range, 1.8 / -u.z()) : range;
    return range * u;
  }

  // On the near and the inner face of one of six boxes, 4 x 1.8 x 1.5 m, in two lanes beside the sensor and one ahead.
  Eigen::Vector3d box_point() {
    const double box = std::floor(uniform(0.0, 6.0));
    const double x = 5.0 + 6.0 * std::floor(box / 2.0);
    const double side = box == 5.0 ? 0.0 : (std::fmod(box, 2.0) == 0.0 ? 1.0 : -1.0);
    const double z = uniform(-1.5, 0.0);
    if (side == 0.0 || uniform(0.0, 1.0) < 0.3) {
      return {x, side * 3.5 + uniform(-0.9, 0.9), z};
    }
    return {x + uniform(0.0, 4.0), side * 2.6, z};
  }

  void add(RawScan& raw, const Eigen::Vector3d& point, bool moves) {
    const Eigen::Vector3d u = point.normalized();
    const double azimuth = std::atan2(u.y(), u.x());
    const double time = scene_.sweep_s * 0.5 * (1.0 + azimuth / 1.6);
    const Eigen::Vector3d v = scene_.v + scene_.a * (time - 0.5 * scene_.sweep_s) -
                              (moves ? scene_.dynamic_outliers : Eigen::Vector3d::Zero());
    const bool gross = uniform(0.0, 1.0) < scene_.outlier_share;
    raw.points.push_back(point);
    raw.doppler.push_back(gross ? uniform(-30.0, 30.0) : -u.dot(v) + scene_.bias + scene_.noise * normal_(random_));
    if (scene_.sweep_s > 0.0) {
      raw.times.push_back(time);
    }
  }

  Scene scene_;
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_;
  std::normal_distribution<double> normal_;
};

inline Scan cast(const Scene& scene, unsigned seed) { return Caster(scene, seed).scan(); }

inline EgoVelocity estimate(const Scan& scan, const EgoPrior& prior = {}, const ConsensusRegressionConfig& config = {},
                            int threads = 1) {
  return estimate_velocity(scan, prior, config, Workers(threads));
}

inline EgoPrior prior_at(const Eigen::Vector3d& velocity, double sigma = 0.5) {
  EgoPrior prior;
  prior.has_velocity = true;
  prior.mean.head<3>() = velocity;
  prior.covariance.topLeftCorner<3, 3>() = sigma * sigma * Eigen::Matrix3d::Identity();
  return prior;
}

}  // namespace dynamic_icp::ego_motion
