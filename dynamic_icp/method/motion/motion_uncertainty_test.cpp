// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/motion/motion_uncertainty.hpp"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace dynamic_icp::motion {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

MotionEvidence usual_evidence() {
  MotionEvidence evidence;
  evidence.source_rotation_covariance = Vector3d(1e-8, 2e-8, 4e-8).asDiagonal();
  evidence.target_rotation_covariance = Vector3d(3e-8, 1e-8, 1e-8).asDiagonal();
  evidence.displacement_covariance = Vector3d(1e-6, 4e-6, 9e-6).asDiagonal();
  return evidence;
}

TEST(MotionCovariance, IsThatOfSampledMotions) {
  // Errors drawn from the evidence, put together as the odometry does, and read off as a left perturbation.
  const MotionEvidence evidence = usual_evidence();
  const Matrix3d R_map_source = exp_so3({0.3, -0.2, 1.0});
  const Matrix3d R_map_target = exp_so3({0.3, -0.18, 1.06});
  const Vector3d displacement_map(1.2, 2.0, -0.1);
  const auto motion = [&](const Vector3d& source_turn, const Vector3d& target_turn, const Vector3d& moved) {
    Eigen::Isometry3d T_map_source = Eigen::Isometry3d::Identity();
    T_map_source.linear() = exp_so3(source_turn) * R_map_source;
    Eigen::Isometry3d T_map_target = Eigen::Isometry3d::Identity();
    T_map_target.linear() = exp_so3(target_turn) * R_map_target;
    // The velocities turn with the source.
    T_map_target.translation() = exp_so3(source_turn) * displacement_map + moved;
    return Eigen::Isometry3d(T_map_target.inverse() * T_map_source);
  };
  const Eigen::Isometry3d exact = motion(Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto draw = [&](const Matrix3d& covariance) -> Vector3d {
    return covariance.llt().matrixL() * Vector3d(normal(random), normal(random), normal(random));
  };
  Matrix6d sum = Matrix6d::Zero();
  constexpr int kDraws = 20000;
  for (int k = 0; k < kDraws; ++k) {
    const Eigen::Isometry3d drawn =
        motion(draw(evidence.source_rotation_covariance), draw(evidence.target_rotation_covariance),
               draw(evidence.displacement_covariance));
    Vector6d e;
    e.head<3>() = log_so3(drawn.linear() * exact.linear().transpose());
    e.tail<3>() = drawn.translation() - exp_so3(e.head<3>()) * exact.translation();
    sum += e * e.transpose() / kDraws;
  }
  const Matrix6d stated = motion_covariance(evidence, R_map_target);
  const auto expect_block = [&](int at) {
    const Matrix3d difference = sum.block<3, 3>(at, at) - stated.block<3, 3>(at, at);
    const Matrix3d block = stated.block<3, 3>(at, at);
    EXPECT_LT(difference.norm(), 0.05 * block.norm()) << at;
  };
  expect_block(0);
  expect_block(3);
}

TEST(MotionCovariance, CarriesEveryErrorToFirstOrder) {
  // One part of the displacement was measured before and turns with the source, the other is that of the target's
  // velocity, in its axes. Derivatives by all errors are taken numerically.
  MotionEvidence evidence = usual_evidence();
  evidence.displacement_rotated = {0.7, -0.3, 0.2};
  const Matrix3d R_map_source = exp_so3({0.3, -0.2, 1.0});
  const Matrix3d R_map_target = exp_so3({0.3, -0.18, 1.06});
  const Vector3d turned_with_source(1.2, 2.0, -0.1);
  const auto motion = [&](const Eigen::Matrix<double, 9, 1>& error) {
    Eigen::Isometry3d T_map_source = Eigen::Isometry3d::Identity();
    T_map_source.linear() = exp_so3(error.head<3>()) * R_map_source;
    Eigen::Isometry3d T_map_target = Eigen::Isometry3d::Identity();
    T_map_target.linear() = exp_so3(error.segment<3>(3)) * R_map_target;
    T_map_target.translation() = exp_so3(error.head<3>()) * turned_with_source + error.tail<3>() +
                                 T_map_target.linear() * evidence.displacement_rotated;
    return Eigen::Isometry3d(T_map_target.inverse() * T_map_source);
  };
  const Eigen::Isometry3d exact = motion(Eigen::Matrix<double, 9, 1>::Zero());
  Eigen::Matrix<double, 6, 9> J;
  for (int k = 0; k < 9; ++k) {
    constexpr double kStep = 1e-5;
    const Eigen::Matrix<double, 9, 1> step = kStep * Eigen::Matrix<double, 9, 1>::Unit(k);
    J.col(k) = (log_se3(motion(step) * exact.inverse()) - log_se3(motion(-step) * exact.inverse())) / (2.0 * kStep);
  }
  Eigen::Matrix<double, 9, 9> errors = Eigen::Matrix<double, 9, 9>::Zero();
  errors.block<3, 3>(0, 0) = evidence.source_rotation_covariance;
  errors.block<3, 3>(3, 3) = evidence.target_rotation_covariance;
  errors.block<3, 3>(6, 6) = evidence.displacement_covariance;
  const Matrix6d expected = J * errors * J.transpose();
  const Matrix6d stated = motion_covariance(evidence, R_map_target);
  for (const int row : {0, 3}) {
    for (const int column : {0, 3}) {
      const Matrix3d block = expected.block<3, 3>(row, column);
      EXPECT_GT(block.norm(), 1e-9) << row << column;
      EXPECT_LT((stated.block<3, 3>(row, column) - block).norm(), 1e-4 * block.norm()) << row << column;
    }
  }
}

TEST(MotionCovariance, IsAsSmallAsTheBetterOfDopplerAndGeometry) {
  MotionEvidence evidence = usual_evidence();
  const double by_doppler = motion_covariance(evidence, Matrix3d::Identity())(3, 3);
  EXPECT_NEAR(by_doppler, 1e-6, 1e-8) << "no geometry at all";
  evidence.source_position_information = Vector3d(1e8, 0.0, 0.0).asDiagonal();
  evidence.target_position_information = Vector3d(1e8, 0.0, 0.0).asDiagonal();
  const Matrix6d both = motion_covariance(evidence, Matrix3d::Identity());
  EXPECT_NEAR(both(3, 3), 1.0 / (1e6 + 0.5e8), 1e-9);
  EXPECT_NEAR(both(4, 4), 4e-6, 1e-7);
}

TEST(PositionInformation, IsTheInverseOfTheMarginalCovariance) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const Matrix6d A = Matrix6d::NullaryExpr([&] { return normal(random); });
  const Matrix6d information = 1e4 * (A * A.transpose() + Matrix6d::Identity());
  const Matrix6d covariance = information.inverse();
  const Matrix3d expected = covariance.bottomRightCorner<3, 3>().inverse();
  EXPECT_LT((position_information(information) - expected).norm(), 1e-6 * expected.norm());
}

TEST(UnknownDirections, NameTheAxisOfATunnel) {
  Matrix6d covariance = 1e-8 * Matrix6d::Identity();
  covariance(3, 3) = 0.25;
  const auto unknown = unobservable_directions(covariance, 30.0, 0.1);
  ASSERT_EQ(unknown.size(), 1u);
  EXPECT_NEAR(std::abs(unknown[0].direction[3]), 1.0, 1e-9);
  EXPECT_TRUE(unobservable_directions(1e-8 * Matrix6d::Identity(), 30.0, 0.1).empty());
}

TEST(UnknownDirections, WeighRotationsByTheirLever) {
  Matrix6d covariance = 1e-10 * Matrix6d::Identity();
  covariance(2, 2) = 0.01 * 0.01;  // 0.01 rad: 0.3 m at 30 m
  EXPECT_EQ(unobservable_directions(covariance, 30.0, 0.1).size(), 1u);
  EXPECT_TRUE(unobservable_directions(covariance, 5.0, 0.1).empty());
}

}  // namespace
}  // namespace dynamic_icp::motion
