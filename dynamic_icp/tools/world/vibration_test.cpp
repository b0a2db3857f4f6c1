// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/vibration.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/tools/world/drive.hpp"

namespace dynamic_icp::world {
namespace {

using Eigen::Vector3d;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A body that drives a bend.
Trajectory driving() {
  const auto route = std::make_shared<const Route>(std::vector<RoutePiece>{{60.0, 0.05, 0.05}});
  return drive(route, SpeedProfile(9.0), {});
}

Eigen::Isometry3d pivot() { return Eigen::Isometry3d(Eigen::Translation3d(1.5, 0.2, 1.9)); }

/// Root mean squares of the displacement (mm) and rotation vector (deg) of the pivot against a body at rest.
struct Spread {
  Vector3d mm = Vector3d::Zero();
  Vector3d deg = Vector3d::Zero();
};

Spread spread(const VibrationConfig& config, double duration_s) {
  const Trajectory shaken = vibrating(stand(Eigen::Isometry3d::Identity()), pivot(), config, RandomSource(5));
  Spread spread;
  const int samples = static_cast<int>(duration_s * 1000.0);
  for (int i = 0; i < samples; ++i) {
    const Eigen::Isometry3d V = pivot().inverse() * shaken(1e-3 * i).T_world_body * pivot();
    spread.mm += (1e3 * V.translation()).cwiseAbs2() / samples;
    spread.deg += (kDegrees * log_so3(V.linear())).cwiseAbs2() / samples;
  }
  return {spread.mm.cwiseSqrt(), spread.deg.cwiseSqrt()};
}

TEST(Vibration, IsOffUnlessAmplitudesAreGiven) {
  const Trajectory body = driving();
  const Trajectory still = vibrating(body, pivot(), {}, RandomSource(5));
  for (const double t : {0.0, 0.37, 4.2}) {
    EXPECT_EQ(still(t).T_world_body.matrix(), body(t).T_world_body.matrix());
    EXPECT_EQ(still(t).velocity_world, body(t).velocity_world);
  }
}

TEST(Vibration, TwistIsTheDerivativeOfThePose) {
  VibrationConfig config;
  config.body.amplitude_mm = 5.0;
  config.wheel = {7.0, 13.0, 1.5, 0.03};
  config.engine.amplitude_deg = 0.02;
  config.bump_s = 0.5;
  config.bump_mm = 30.0;
  config.bump_deg = 0.8;
  const Trajectory shaken = vibrating(driving(), pivot(), config, RandomSource(5));
  const double h = 1e-5;
  for (double t = 0.013; t < 1.2; t += 0.021) {
    const MotionState state = shaken(t);
    const Eigen::Isometry3d before = shaken(t - h).T_world_body;
    const Eigen::Isometry3d after = shaken(t + h).T_world_body;
    const Vector3d velocity = (after.translation() - before.translation()) / (2.0 * h);
    const Vector3d rate = log_so3(after.linear() * before.linear().transpose()) / (2.0 * h);
    EXPECT_LT((state.velocity_world - velocity).norm(), 1e-5) << t;
    EXPECT_LT((state.angular_velocity_world - rate).norm(), 1e-5) << t;
  }
}

TEST(Vibration, HasThePowerOfASineOfItsAmplitudeOnEachAxis) {
  VibrationConfig config;
  config.wheel = {7.0, 13.0, 1.5, 0.03};
  const Spread spread = world::spread(config, 60.0);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(spread.mm[axis], 1.5 / std::sqrt(2.0), 0.03) << axis;
    EXPECT_NEAR(spread.deg[axis], 0.03 / std::sqrt(2.0), 0.0006) << axis;
  }
}

TEST(Vibration, StaysWithinItsBand) {
  VibrationConfig config;
  config.engine.amplitude_mm = 1.0;  // 20 to 30 Hz
  const Trajectory shaken = vibrating(stand(Eigen::Isometry3d::Identity()), pivot(), config, RandomSource(8));
  // Power at one frequency by projection on its sine and cosine over 10 s.
  std::vector<double> z;
  for (int i = 0; i < 2000; ++i) {
    z.push_back(shaken(5e-3 * i).T_world_body.translation().z());
  }
  const auto power = [&](double hz) {
    double c = 0.0, s = 0.0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double phase = 2.0 * std::numbers::pi * hz * 5e-3 * static_cast<double>(i);
      c += z[i] * std::cos(phase);
      s += z[i] * std::sin(phase);
    }
    return c * c + s * s;
  };
  double within = 0.0, outside = 0.0;
  for (double hz = 1.0; hz < 60.0; hz += 0.1) {
    (hz > 19.5 && hz < 30.5 ? within : outside) += power(hz);
  }
  EXPECT_LT(outside, 0.02 * within);
}

TEST(Vibration, BumpIsOneImpulseOfItsHeight) {
  VibrationConfig config;
  config.bump_s = 2.0;
  config.bump_mm = 30.0;
  const Trajectory shaken = vibrating(stand(Eigen::Isometry3d::Identity()), pivot(), config, RandomSource(5));
  double highest = 0.0;
  for (double t = 0.0; t < 4.0; t += 1e-4) {
    const double z = shaken(t).T_world_body.translation().z();
    highest = std::max(highest, z);
    if (t <= 2.0) {
      EXPECT_EQ(z, 0.0);
    }
  }
  EXPECT_NEAR(highest, 0.030, 1e-6);
  EXPECT_LT(std::abs(shaken(3.0).T_world_body.translation().z()), 1e-5) << "it dies away";
}

TEST(Vibration, ImpossibleBandsAreRefused) {
  VibrationConfig config;
  EXPECT_NO_THROW(check(config));
  config.wheel.low_hz = 20.0;
  EXPECT_THROW(check(config), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::world
