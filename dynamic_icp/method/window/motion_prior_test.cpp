// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/motion_prior.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kKnot_s = 0.0125;

struct Motion {
  SplineTrajectory trajectory{kKnot_s};
  Layout layout;

  explicit Motion(double duration_s, bool vibrates = true) {
    trajectory.begin(0.0, duration_s, Eigen::Isometry3d::Identity(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    layout = {0, static_cast<Index>(trajectory.coefficients().size()), vibrates};
  }

  [[nodiscard]] std::size_t count() const { return trajectory.coefficients().size(); }

  void add(const VectorXd& step) {
    for (std::size_t k = 0; k < count(); ++k) {
      trajectory.coefficients()[k] += step.segment<6>(layout.coefficient(k));
      if (layout.vibrates) {
        trajectory.vibration()[k] += step.segment<6>(layout.vibration(k));
      }
    }
  }
};

struct PriorSums {
  MatrixXd H;
  VectorXd g;
};

PriorSums sums_of(const MotionPrior& prior, const Motion& motion, std::size_t first_new = 0) {
  const Index n = motion.layout.size();
  PriorSums sums{MatrixXd::Zero(n, n), VectorXd::Zero(n)};
  prior.add(motion.trajectory, first_new, motion.layout, sums.H, sums.g);
  return sums;
}

VectorXd random_step(std::mt19937& random, Index n, double scale) {
  std::normal_distribution<double> normal(0.0, scale);
  return VectorXd::NullaryExpr(n, [&] { return normal(random); });
}

TEST(MotionPrior, SmoothMotionIsWhiteNoiseOnTheJerkOfWhatIsNotVibration) {
  std::mt19937 random(1);
  WindowConfig config;
  const MotionPrior prior(config);
  Motion motion(0.1);
  motion.add(random_step(random, motion.layout.size(), 1e-3));
  Motion without = motion;
  for (Vector6d& v : without.trajectory.vibration()) {
    v.setZero();
  }
  // The same vibration added to the coefficients and to the vibration costs nothing as motion.
  Motion moved = without;
  for (std::size_t k = 0; k < moved.count(); ++k) {
    moved.trajectory.vibration()[k] = motion.trajectory.vibration()[k];
    moved.trajectory.coefficients()[k] += motion.trajectory.vibration()[k];
  }
  const auto of_coefficients = [](const Motion& m, const VectorXd& g) {
    return VectorXd(g.segment(m.layout.coefficient(0), 6 * m.layout.coefficients));
  };
  const VectorXd a = of_coefficients(without, sums_of(prior, without).g);
  const VectorXd b = of_coefficients(moved, sums_of(prior, moved).g);
  EXPECT_GT(a.norm(), 0.0);
  EXPECT_LT((a - b).norm(), 1e-9 * a.norm());
  // And that gradient is J^T j / q.
  VectorXd expected = VectorXd::Zero(a.size());
  const std::array<double, 4> w = jerk_weights(kKnot_s);
  for (std::size_t k = 0; k + 3 < without.count(); ++k) {
    const auto c = [&](std::size_t i) { return without.trajectory.coefficients()[k + i]; };
    const Vector6d before = (c(2) - 2.0 * c(1) + c(0)) / (kKnot_s * kKnot_s);
    const Vector6d after = (c(3) - 2.0 * c(2) + c(1)) / (kKnot_s * kKnot_s);
    const Vector6d jerk = (after - std::exp(-kKnot_s / 2.0) * before) / kKnot_s;
    for (std::size_t i = 0; i < 4; ++i) {
      expected.segment<6>(6 * static_cast<Index>(k + i)) += w[i] * jerk.cwiseQuotient(prior.jerk_variance());
    }
  }
  EXPECT_LT((a - expected).norm(), 1e-9 * expected.norm());
}

TEST(MotionPrior, IsTheQuadraticOfItsGradient) {
  std::mt19937 random(2);
  const MotionPrior prior{WindowConfig{}};
  for (const std::size_t first_new : {std::size_t{0}, std::size_t{4}}) {
    Motion motion(0.1);
    motion.add(random_step(random, motion.layout.size(), 1e-3));
    const PriorSums before = sums_of(prior, motion, first_new);
    const VectorXd step = random_step(random, motion.layout.size(), 1e-3);
    motion.add(step);
    const PriorSums after = sums_of(prior, motion, first_new);
    EXPECT_EQ(before.H, after.H);
    EXPECT_LT((before.g + before.H * step - after.g).norm(), 1e-9 * after.g.norm());
    EXPECT_LT((before.H - before.H.transpose()).norm(), 1e-12 * before.H.norm());
  }
}

TEST(MotionPrior, TheVibrationIsStationaryAndLivesAtTheFrequencyOfWheels) {
  const MotionPrior prior{WindowConfig{}};
  const Motion motion(1.0);
  PriorSums sums = sums_of(prior, motion);
  sums.H.diagonal().segment(motion.layout.coefficient(0), 6 * motion.layout.coefficients).array() += 1.0;
  sums.H.diagonal().head(Layout::kBefore).array() += 1.0;
  const MatrixXd covariance = dense::inverse(sums.H);
  const Vector6d variance = prior.vibration_variance();
  EXPECT_GT(variance.minCoeff(), 0.0);
  const Index first = motion.layout.vibration(0);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{50}, motion.count() - 1}) {
    for (Index axis = 0; axis < 6; ++axis) {
      const Index at = motion.layout.vibration(k) + axis;
      EXPECT_NEAR(covariance(at, at), variance[axis], 1e-3 * variance[axis]) << k;
    }
  }
  const auto power = [&](double frequency_hz) {
    VectorXd wave = VectorXd::Zero(6 * motion.layout.coefficients);
    for (std::size_t k = 0; k < motion.count(); ++k) {
      wave[6 * static_cast<Index>(k) + 3] =
          std::sin(2.0 * std::numbers::pi * frequency_hz * kKnot_s * static_cast<double>(k));
    }
    const Index n = 6 * motion.layout.coefficients;
    return wave.dot(covariance.block(first, first, n, n) * wave);
  };
  EXPECT_GT(power(11.0), 3.0 * power(2.0));
  EXPECT_GT(power(11.0), 3.0 * power(25.0));
}

/// Standard deviation of forward vibration and jerk as learned from scans of 0.1 s of a motion measured at each knot.
struct Learned {
  double vibration_m = 0.0;
  double roll_rad = 0.0;
  double jerk_mps3 = 0.0;
};

Learned learned(double amplitude_m, int scans = 12) {
  constexpr double kMeasured_m = 1e-4;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0.0, kMeasured_m);
  MotionPrior prior{WindowConfig{}};
  for (int scan = 0; scan < scans; ++scan) {
    Motion motion(0.4);
    PriorSums sums = sums_of(prior, motion);
    sums.H.diagonal().array() += 1.0;  // all within 1 m
    for (std::size_t k = 0; k < motion.count(); ++k) {
      const double t = 0.4 * scan + kKnot_s * static_cast<double>(k);
      double x = 0.0;
      for (const double frequency_hz : {8.7, 10.9, 13.6}) {
        x += amplitude_m / std::sqrt(3.0) * std::sin(2.0 * std::numbers::pi * frequency_hz * t + frequency_hz);
      }
      for (Index axis = 3; axis < 6; ++axis) {
        const Index at = motion.layout.coefficient(k) + axis;
        sums.H(at, at) += 1.0 / (kMeasured_m * kMeasured_m);
        sums.g[at] -= (x + normal(random)) / (kMeasured_m * kMeasured_m);
      }
    }
    const Index head = motion.layout.head();
    RestFactor factor;
    factor.set_tail(sums.H.bottomRows(sums.H.rows() - head));
    factor.compute(sums.H.topLeftCorner(head, head));
    motion.add(-factor.solve(sums.g));
    prior.learn(motion.trajectory, 8, 16, motion.layout, factor);
    prior.keep();
  }
  return {std::sqrt(prior.vibration_variance()[3]), std::sqrt(prior.vibration_variance()[0]),
          std::sqrt(prior.jerk_variance()[3])};
}

TEST(MotionPrior, LearnsHowMuchASensorVibrates) {
  const Learned shaken = learned(0.8e-3);  // rms 0.57 mm
  EXPECT_GT(shaken.vibration_m, 0.25e-3);
  EXPECT_LT(shaken.vibration_m, 0.9e-3);
  EXPECT_LT(shaken.jerk_mps3, 60.0) << "its jerk is 160 m/s^3";
  EXPECT_GT(shaken.roll_rad, 0.1e-3) << "what is shaken turns, too";
  const Learned still = learned(0.0);
  EXPECT_LT(still.vibration_m, 0.1e-3);
}

TEST(MotionPrior, MoreUnknownsOnlyWhereItVibrates) {
  const MotionPrior prior{WindowConfig{}};
  const Motion motion(0.1, false);
  const PriorSums sums = sums_of(prior, motion);
  EXPECT_EQ(sums.H.rows(), Layout::kBefore + 6 * motion.layout.coefficients);
  EXPECT_GT(sums.H.norm(), 0.0);
}

// Else a turn that nothing measures, as over a flat road between vehicles, goes on to any speed.
TEST(MotionPrior, AccelerationsFadeWhereNothingIsMeasured) {
  const MotionPrior prior{WindowConfig{}};
  const double acceleration = 0.8;  // rad/s^2, about z
  Motion motion(4.0, false);
  const Index n = motion.layout.size();
  PriorSums sums = sums_of(prior, motion);
  sums.H.diagonal().head(Layout::kBefore).array() += 1.0;
  for (std::size_t k = 0; k < 3; ++k) {  // the beginning of a turn is known
    const double t = kKnot_s * static_cast<double>(k);
    const Index at = motion.layout.coefficient(k);
    sums.H.diagonal().segment(at, 6).array() += 1e18;
    sums.g[at + 2] -= 1e18 * 0.5 * acceleration * t * t;
  }
  const VectorXd step = Eigen::LDLT<MatrixXd>(sums.H).solve(-sums.g);
  ASSERT_EQ(step.size(), n);
  const auto yaw = [&](std::size_t k) { return step[motion.layout.coefficient(k) + 2]; };
  for (const std::size_t k : {std::size_t{80}, std::size_t{160}, motion.count() - 2}) {
    const double rate = (yaw(k + 1) - yaw(k)) / kKnot_s;
    const double t = kKnot_s * (static_cast<double>(k) + 0.5);
    EXPECT_NEAR(rate, acceleration * 2.0 * (1.0 - std::exp(-t / 2.0)), 0.05) << t;
  }
}

// Else the acceleration of a vehicle that was even for some seconds is believed to stay when it brakes.
TEST(MotionPrior, NoAccelerationIsKnownToLast) {
  // White noise of the jerk, q in each knot interval, changes an acceleration within a second by sqrt(q h 1 s).
  const double change_mps2 = learned(0.0, 100).jerk_mps3 * std::sqrt(kKnot_s);
  EXPECT_GT(change_mps2, 0.5);
  EXPECT_LT(change_mps2, 1.0) << "that there is little of it was learned";
}

}  // namespace
}  // namespace dynamic_icp::window
