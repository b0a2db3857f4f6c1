// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What Doppler says about rotation and about pairs of points: the formulas of docs/derivations/doppler-and-rotation.md
// against worlds built from positions over time, numeric derivatives and dense matrices.
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/registration/doppler_rotation.hpp"

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::registration {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDt = 0.1;      // s, between the scans
constexpr double kSigma = 0.05;  // m/s, of a Doppler

/// A sensor that moves along position(t), axes R(t) = exp(omega t); scan 1 at t = 0 (world axes), scan 2 at t = dt.
struct Drive {
  Vector3d velocity, acceleration, omega;

  [[nodiscard]] Vector3d position(double t) const { return velocity * t + 0.5 * t * t * acceleration; }
  [[nodiscard]] Matrix3d R_world_sensor(double t) const { return exp_so3(t * omega); }
  [[nodiscard]] Vector3d in_sensor(const Vector3d& point, double t) const {
    return R_world_sensor(t).transpose() * (point - position(t));
  }
  /// The rate of the range of a static point, from ranges alone.
  [[nodiscard]] double doppler(const Vector3d& point, double t) const {
    constexpr double kStep = 1e-5;
    return ((point - position(t + kStep)).norm() - (point - position(t - kStep)).norm()) / (2.0 * kStep);
  }
  [[nodiscard]] Vector3d velocity_sensor(double t) const {
    return R_world_sensor(t).transpose() * (velocity + t * acceleration);
  }
  [[nodiscard]] Matrix3d R_target_source() const { return R_world_sensor(kDt).transpose(); }
};

/// A static point seen in both scans, and the paper's residual of the pair at the true rotation.
struct Pair {
  Pair(const Drive& drive, const Vector3d& point) {
    const Vector3d p = drive.in_sensor(point, 0.0);
    const Vector3d q = drive.in_sensor(point, kDt);
    w = drive.R_target_source() * p.normalized();
    u = q.normalized();
    range = q.norm();
    s_source = drive.doppler(point, 0.0);
    s_target = drive.doppler(point, kDt);
    residual = doppler_rotation(s_source * w, u, s_target);
  }
  Vector3d w, u;  // lines of sight of source (turned into the target frame) and target
  double range, s_source, s_target;
  Residual residual;
};

class DopplerInformation : public ::testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vector3d vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Drive drive() { return {Vector3d(20.0, 0.0, 0.0) + vector(2.0), vector(3.0), vector(0.5)}; }
  Vector3d point() { return uniform(10.0, 60.0) * vector(1.0).normalized() + Vector3d(15.0, 0.0, 0.0); }

  /// Lines of sight in 120 x 19.2 degrees.
  std::vector<Vector3d> view(std::size_t count) {
    std::vector<Vector3d> directions(count);
    for (Vector3d& u : directions) {
      const double azimuth = uniform(-M_PI / 3.0, M_PI / 3.0);
      const double elevation = uniform(-M_PI / 18.75, M_PI / 18.75);
      u = {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
    }
    return directions;
  }

  std::mt19937 random_{7};
};

MatrixXd numeric_jacobian(const std::function<VectorXd(const VectorXd&)>& f, Eigen::Index columns) {
  constexpr double kStep = 1e-5;
  MatrixXd J;
  for (Eigen::Index k = 0; k < columns; ++k) {
    const VectorXd x = kStep * VectorXd::Unit(columns, k);
    const VectorXd column = (f(x) - f(-x)) / (2.0 * kStep);
    J.conservativeResize(column.size(), columns);
    J.col(k) = column;
  }
  return J;
}

/// Information about the first `kept` unknowns when the others are unknown as well.
MatrixXd marginal(const MatrixXd& H, Eigen::Index kept) {
  const Eigen::Index rest = H.rows() - kept;
  return H.topLeftCorner(kept, kept) -
         H.topRightCorner(kept, rest) * dense::solve(H.bottomRightCorner(rest, rest), H.bottomLeftCorner(rest, kept));
}

TEST_F(DopplerInformation, ThePapersResidualOfTheSamePointIsNotZeroAtTheTrueRotation) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Drive d = drive();
    const Pair pair(d, point());
    const Vector3d v_2 = d.velocity_sensor(kDt);
    const Vector3d change = v_2 - d.R_target_source() * d.velocity_sensor(0.0);
    const Vector3d moved = d.R_target_source() * d.position(kDt);
    const Vector3d across = moved - pair.w * pair.w.dot(moved);
    const double expected = -across.dot(v_2) / pair.range + pair.u.dot(pair.w) * pair.w.dot(change);
    EXPECT_NEAR(pair.residual.value, expected, 1e-6);
  }
}

TEST_F(DopplerInformation, AtConstantVelocityItIsMinusTheSquaredSpeedAcrossTimesTimeOverRange) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    Drive d = drive();
    d.acceleration.setZero();
    const Pair pair(d, point());
    const Vector3d v = d.velocity_sensor(kDt);
    const double across = v.cross(pair.w).norm();
    EXPECT_NEAR(pair.residual.value, -across * across * kDt / pair.range, 1e-6);
  }
}

TEST_F(DopplerInformation, ItsJacobianIsTheDopplerTimesTheSineOfTheParallax) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    Drive d = drive();
    d.acceleration.setZero();
    const Pair pair(d, point());
    const Vector3d moved = d.R_target_source() * d.position(kDt);
    const Vector3d J = pair.residual.jacobian.head<3>();
    EXPECT_NEAR(J.norm(), std::abs(pair.s_source) * moved.cross(pair.w).norm() / pair.range, 1e-6);
    // Roll about the direction of travel is invisible, and so is translation.
    EXPECT_NEAR(J.dot(moved.normalized()), 0.0, 1e-6);
    EXPECT_TRUE(pair.residual.jacobian.tail<3>().isZero(0.0));
  }
}

TEST_F(DopplerInformation, AnyTwoStaticPointsExplainEachOthersDoppler) {
  for (int repeat = 0; repeat < 100; ++repeat) {
    const Drive d = drive();
    const Pair one(d, point());
    const Pair other(d, point());
    const Vector3d v_1 = d.R_target_source() * d.velocity_sensor(0.0);
    const double difference = (other.s_target + other.u.dot(d.velocity_sensor(kDt))) - (one.s_source + one.w.dot(v_1));
    EXPECT_NEAR(difference, 0.0, 1e-6);
  }
}

/// Unknowns: a turn theta of the axes of scan 2, the velocity at scan 1, that at scan 2, all in the axes of scan 1.
class JointInformation : public DopplerInformation {
 protected:
  void SetUp() override {
    const std::vector<Vector3d> view_1 = view(500);
    const std::vector<Vector3d> view_2 = view(500);
    const auto doppler = [&](const VectorXd& x) {
      const Matrix3d R = exp_so3(x.head<3>()) * R_;
      VectorXd s(1000);
      for (Eigen::Index i = 0; i < 500; ++i) {
        s[i] = -view_1[static_cast<std::size_t>(i)].dot(v_ + x.segment<3>(3));
        s[500 + i] = -view_2[static_cast<std::size_t>(i)].dot(R * (v_ + x.tail<3>()));
      }
      return s;
    };
    const MatrixXd J = numeric_jacobian(doppler, 9);
    H_ = J.transpose() * J / (kSigma * kSigma);
    covariance_1_ = covariance(view_1);
    covariance_2_ = covariance(view_2);
  }

  static Matrix3d covariance(const std::vector<Vector3d>& directions) {
    Matrix3d sum = Matrix3d::Zero();
    for (const Vector3d& u : directions) {
      sum += u * u.transpose();
    }
    return kSigma * kSigma * sum.inverse();
  }

  Matrix3d R_ = exp_so3({0.01, -0.02, 0.05});
  Vector3d v_{20.0, 0.5, -0.3};
  MatrixXd H_;
  Matrix3d covariance_1_, covariance_2_;
};

TEST_F(JointInformation, OfAllStaticDopplerIsAboutTheVelocitiesAlone) {
  const VectorXd eigenvalues = dense::symmetric_parts(H_).values;
  EXPECT_LT(eigenvalues[2], 1e-6 * eigenvalues[8]);
  EXPECT_GT(eigenvalues[3], 1e-6 * eigenvalues[8]);
  // Known velocities would say something; that is where the appearance comes from.
  const double of_known_velocities = H_.topLeftCorner(3, 3).norm();
  EXPECT_GT(of_known_velocities, 1e4);
  EXPECT_LT(marginal(H_, 3).norm(), 1e-6 * of_known_velocities);
}

TEST_F(JointInformation, AnAccelerationPriorTellsTwoAxesOfTheTurn) {
  const double change = 3.0 * kDt;  // m/s, standard deviation of the change of velocity
  MatrixXd difference(3, 9);
  difference << Matrix3d::Zero(), -Matrix3d::Identity(), Matrix3d::Identity();
  const MatrixXd information = marginal(H_ + difference.transpose() * difference / (change * change), 3);
  const Matrix3d S = change * change * Matrix3d::Identity() + R_ * covariance_1_ * R_.transpose() + covariance_2_;
  const Vector3d v_2 = R_ * v_;
  const Matrix3d expected = skew(v_2).transpose() * S.inverse() * skew(v_2);
  EXPECT_LT((information - expected).norm(), 1e-4 * expected.norm());
  EXPECT_LT((information * v_2.normalized()).norm(), 1e-4 * expected.norm());
}

TEST_F(DopplerInformation, TheDisplacementTermCouplesTurnAndTranslationByHalfThePath) {
  const Vector3d v_1(20.0, 1.0, -0.5);
  const Vector3d v_2(19.0, -1.0, 0.3);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = exp_so3({0.02, -0.03, 0.06});
  T.translation() = -0.5 * kDt * (T.linear() * v_1 + v_2);
  const auto term = [&](const VectorXd& x) -> VectorXd {
    const Eigen::Isometry3d X = exp_se3(x) * T;
    return X.translation() + 0.5 * kDt * (X.linear() * v_1 + v_2);
  };
  MatrixXd expected(3, 6);
  expected << 0.5 * kDt * skew(v_2), Matrix3d::Identity();
  const MatrixXd J = numeric_jacobian(term, 6);
  EXPECT_LT((J - expected).norm(), 1e-6);

  // Alone it says nothing of the turn; with a position from elsewhere it does, as far as both are known.
  const Matrix3d term_covariance = 1e-7 * Vector3d(1.0, 2.0, 4.0).asDiagonal();
  const Matrix3d position_covariance = 1e-6 * Vector3d(3.0, 1.0, 1.0).asDiagonal();
  MatrixXd H = J.transpose() * term_covariance.inverse() * J;
  EXPECT_LT(marginal(H, 3).norm(), 1e-6 * H.topLeftCorner(3, 3).norm());
  H.bottomRightCorner<3, 3>() += position_covariance.inverse();
  const Matrix3d C = 0.5 * kDt * skew(v_2);
  const Matrix3d information = C.transpose() * (term_covariance + position_covariance).inverse() * C;
  EXPECT_LT((marginal(H, 3) - information).norm(), 1e-5 * information.norm());
}

TEST_F(DopplerInformation, AMovingObjectTellsNoMoreOfThePoseThanItsPredictedPlace) {
  constexpr double kPlane = 0.02;  // m
  constexpr double kPlace = 0.01;  // m, error of the predicted displacement, the same for all its points
  for (const Eigen::Index n : {10, 100, 500}) {
    MatrixXd N(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      N.row(i) = vector(1.0).normalized();
    }
    const MatrixXd S = kPlane * kPlane * MatrixXd::Identity(n, n) + kPlace * kPlace * N * N.transpose();
    const Matrix3d information = N.transpose() * dense::solve(S, N);
    const Matrix3d sum = N.transpose() * N;
    const Matrix3d place = kPlace * kPlace * Matrix3d::Identity();
    const Matrix3d expected = (place + kPlane * kPlane * sum.inverse()).inverse();
    EXPECT_LT((information - expected).norm(), 1e-9 * expected.norm());
    const Vector3d eigenvalues = dense::symmetric_parts(information).values;
    EXPECT_LT(eigenvalues[2], 1.0 / (kPlace * kPlace));
  }
}

TEST_F(DopplerInformation, PointsThatShareTheErrorOfTheirPlaneWeighLess) {
  constexpr Eigen::Index kPoints = 40;
  constexpr double kOwn = 4e-4;       // m^2
  constexpr double kShared = 2.5e-5;  // m^2
  const MatrixXd ones = MatrixXd::Ones(kPoints, kPoints);
  const MatrixXd W = (kOwn * MatrixXd::Identity(kPoints, kPoints) + kShared * ones).inverse();
  // A move along the normal, the same for all points: the weight of each is 1 / (own + m shared).
  EXPECT_NEAR(W.sum(), kPoints / (kOwn + kPoints * kShared), 1e-9 * W.sum());
  // Any rows: what they have in common weighs that much, how they differ weighs 1 / own.
  const MatrixXd J = MatrixXd::NullaryExpr(kPoints, 6, [&] { return uniform(-1.0, 1.0); });
  const VectorXd mean = J.colwise().mean();
  const MatrixXd spread = J.rowwise() - mean.transpose();
  const MatrixXd expected =
      spread.transpose() * spread / kOwn + kPoints / (kOwn + kPoints * kShared) * mean * mean.transpose();
  EXPECT_LT((J.transpose() * W * J - expected).norm(), 1e-9 * expected.norm());
}

}  // namespace
}  // namespace dynamic_icp::registration
