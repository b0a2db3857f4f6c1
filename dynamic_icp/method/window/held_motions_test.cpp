// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <random>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "dynamic_icp/method/window/plane_terms.hpp"

#include "testing/one_thread.hpp"
#include "testing/swept_room.hpp"

// Which motions of the sensor planes hold, and which the noise of their normals only seems to.
namespace dynamic_icp::window {
namespace {

using Eigen::Vector3d;
using mapping::PlaneMap;

/// [roll; pitch; yaw; x; y; z] of a sensor that stands at the origin.
Vector6d along_axis(Eigen::Index axis) { return Matrix6d::Identity().col(axis); }

struct Information {
  Vector6d held;
  Eigen::MatrixXd H;

  /// Of a small motion of the sensor.
  [[nodiscard]] double about(const Vector6d& motion) const {
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(H.rows());
    for (Eigen::Index k = Layout::kBefore; k < H.rows(); k += 6) {
      shift.segment<6>(k) = motion;
    }
    return shift.dot(H * shift);
  }
};

Information information(const PlaneMap& map, const std::vector<Vector3d>& seen, const PlaneNoise& noise) {
  RawScan raw;
  raw.points = seen;
  raw.doppler.assign(seen.size(), 0.0);
  const Scan scan = Scan::from_raw(raw);
  SplineTrajectory still(0.0125);
  still.begin(0.0, 0.0, Eigen::Isometry3d::Identity(), Vector3d::Zero(), Vector3d::Zero());
  PlaneTerms terms(scan, map, 0.0, 0.01, kOneThread);
  terms.associate(still, Eigen::VectorXd::Zero(Layout::kMapError), noise, false);
  const Layout at{0, static_cast<Eigen::Index>(still.coefficients().size())};
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(at.size(), at.size());
  Eigen::VectorXd g = Eigen::VectorXd::Zero(at.size());
  terms.add(at, H, g);
  return {terms.quality().held, H.selfadjointView<Eigen::Lower>()};
}

/// What is left of the information about a motion that the planes seem to have.
double share_held(const PlaneMap& map, const std::vector<Vector3d>& seen, const Vector6d& motion) {
  PlaneNoise no_noise;
  no_noise.max_noise_share = 1e9;
  const double apparent = information(map, seen, no_noise).about(motion);
  EXPECT_GT(apparent, 0.0);
  return information(map, seen, {}).about(motion) / apparent;
}

TEST(HeldMotions, AreAllInARoom) {
  const Room room;
  EXPECT_GT(information(room.map(), room.points(2, 3000), {}).held.minCoeff(), 0.97);
}

TEST(HeldMotions, AreAllButTheOneAlongATunnel) {
  Room tunnel;
  tunnel.has_ends = false;
  const PlaneMap map = tunnel.map(8000);
  const std::vector<Vector3d> seen = tunnel.points(2, 3000);
  const Vector6d held = information(map, seen, {}).held;
  EXPECT_LT(held[5], 0.01);
  EXPECT_GT(held[4], 0.97);
  EXPECT_LT(share_held(map, seen, along_axis(3)), 0.05);
  for (const Eigen::Index axis : {0, 1, 2, 4, 5}) {
    EXPECT_GT(share_held(map, seen, along_axis(axis)), 0.95) << axis;
  }
}

TEST(HeldMotions, AreNoShiftsOnTheGroundAndNoTurnsOnIt) {
  const auto ground = [](unsigned seed, std::size_t count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-10.0, 10.0);
    std::normal_distribution<double> height(-1.5, 0.02);
    std::vector<Vector3d> points(count);
    for (Vector3d& point : points) {
      point.x() = uniform(random);
      point.y() = uniform(random);
      point.z() = height(random);
    }
    return points;
  };
  PlaneMap map({});
  map.add(ground(1, 8000), Vector3d::Zero(), kOneThread);
  const std::vector<Vector3d> seen = ground(2, 3000);
  for (const Eigen::Index axis : {2, 3, 4}) {
    EXPECT_LT(share_held(map, seen, along_axis(axis)), 0.1) << axis;
  }
  for (const Eigen::Index axis : {0, 1, 5}) {
    EXPECT_GT(share_held(map, seen, along_axis(axis)), 0.95) << axis;
  }
}

}  // namespace
}  // namespace dynamic_icp::window
