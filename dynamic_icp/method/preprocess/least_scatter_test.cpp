// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/preprocess/least_scatter.hpp"

#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace dynamic_icp::preprocess {
namespace {

class Matrices {
 public:
  Eigen::Matrix3d with_eigenvalues(const Eigen::Vector3d& values) {
    const Eigen::Matrix3d Q = rotation();
    return Q * values.asDiagonal() * Q.transpose();
  }
  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(normal_(random_), normal_(random_), normal_(random_), normal_(random_))
        .normalized()
        .toRotationMatrix();
  }
  double power_of_ten(double least, double most) {
    return std::pow(10.0, std::uniform_real_distribution<double>(least, most)(random_));
  }

 private:
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

/// Angle between two axes, rad.
double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::asin(std::min(1.0, a.cross(b).norm() / (a.norm() * b.norm())));
}

TEST(LeastScatter, AgreesWithEigenWhateverTheEigenvalues) {
  Matrices matrices;
  constexpr double kEps = 2.3e-16;
  for (int i = 0; i < 20000; ++i) {
    const double unit = matrices.power_of_ten(-11.0, 6.0);
    const double middle = unit * matrices.power_of_ten(-6.0, 0.0);
    const double smallest = i % 3 == 0 ? 0.0 : middle * matrices.power_of_ten(-9.0, 0.0);
    const Eigen::Matrix3d scatter = matrices.with_eigenvalues({middle, unit, smallest});
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
    const LeastScatter least = least_scatter(scatter);
    ASSERT_NEAR(least.direction.norm(), 1.0, 1e-15);
    ASSERT_NEAR(least.middle, eigen.eigenvalues()[1], 1e4 * kEps * unit);
    const double gap = eigen.eigenvalues()[1] - eigen.eigenvalues()[0];
    ASSERT_LE(angle(least.direction, eigen.eigenvectors().col(0)), 100.0 * kEps * unit / gap)
        << "eigenvalues " << eigen.eigenvalues().transpose();
  }
}

TEST(LeastScatter, OfDegenerateMatricesIsAnEigenvector) {
  Matrices matrices;
  const std::vector<Eigen::Vector3d> values{{0, 0, 0},    {1, 0, 0},       {1, 1, 0},
                                            {1, 1, 1},    {2, 1, 1},       {1, 1, 1 - 1e-9},
                                            {1, 1e-9, 0}, {1, 1e-9, 1e-9}, {1e-300, 1e-300, 0}};
  for (const Eigen::Vector3d& eigenvalues : values) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Matrix3d scatter =
          i == 0 ? Eigen::Matrix3d(eigenvalues.asDiagonal()) : matrices.with_eigenvalues(eigenvalues);
      const LeastScatter least = least_scatter(scatter);
      ASSERT_NEAR(least.direction.norm(), 1.0, 1e-15);
      ASSERT_LE((scatter * least.direction - eigenvalues.minCoeff() * least.direction).norm(),
                1e-14 * eigenvalues.maxCoeff());
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::preprocess
