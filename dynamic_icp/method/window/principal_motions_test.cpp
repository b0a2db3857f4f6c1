// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/principal_motions.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace dynamic_icp::window {
namespace {

constexpr int kPatches = 40;
constexpr double kShare = 0.2;
constexpr double kSigma = 0.05;  // of what the error of a normal adds to m . v

/// Patches that show all motions but `hidden`, and that one by their noise alone.
class Scans {
 public:
  explicit Scans(unsigned seed) : random_(seed) {}

  MotionInformation see(const Vector6d& hidden) {
    MotionInformation scan;
    for (int k = 0; k < kPatches; ++k) {
      Vector6d m;
      for (double& one : m) {
        one = normal_(random_);
      }
      m += (kSigma * normal_(random_) - m.dot(hidden)) * hidden;
      scan.all += m * m.transpose();
      scan.noise += kSigma * kSigma * hidden * hidden.transpose();
    }
    return scan;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

/// Most of its information is noise.
Vector6d most_hidden(const PrincipalMotions& principal) {
  Eigen::Index most = 0;
  principal.noise_shares.maxCoeff(&most);
  return principal.motions.col(most).normalized();
}

double angle_between(const Vector6d& a, const Vector6d& b) { return std::acos(std::min(1.0, std::abs(a.dot(b)))); }

/// Of the axis 4, turned towards 3.
Vector6d turned(double angle_rad) {
  Vector6d motion = Vector6d::Zero();
  motion[4] = std::cos(angle_rad);
  motion[3] = std::sin(angle_rad);
  return motion;
}

TEST(PrincipalMotions, AreTheGeneralisedEigenvectors) {
  Scans scans(1);
  MotionInformation scan = scans.see(turned(0.3));
  scan.noise += Vector6d(0.1, 0.2, 0.3, 0.4, 0.5, 0.6).asDiagonal();
  const PrincipalMotions found = principal_motions(scan);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> expected(scan.noise, scan.all);
  EXPECT_LT((found.noise_shares - expected.eigenvalues()).norm(), 1e-12);
  EXPECT_LT((found.motions.transpose() * scan.all * found.motions - Matrix6d::Identity()).norm(), 1e-9);
  const Matrix6d shares = found.noise_shares.asDiagonal();
  EXPECT_LT((found.motions.transpose() * scan.noise * found.motions - shares).norm(), 1e-12);
}

TEST(PrincipalMotions, AreThoseOfTheScanWhereNothingIsPast) {
  Scans scans(2);
  const MotionInformation scan = scans.see(turned(0.0));
  const ContinuedMotions found = continue_motions(scan, {}, kPatches, kShare);
  EXPECT_LT(angle_between(most_hidden(found.principal), most_hidden(principal_motions(scan))), 1e-6);
  EXPECT_LT((found.sums.all - scan.all).norm(), 1e-12);
}

TEST(PrincipalMotions, OfManyScansAreKnownAsWellAsAllTheirNormalsTogether) {
  Scans scans(3);
  const Vector6d hidden = turned(0.5);
  constexpr int kScans = 100;
  MotionInformation past;
  double of_one = 0.0;
  double last = 0.0;
  int agreed = 0;
  for (int k = 0; k < kScans; ++k) {
    const MotionInformation scan = scans.see(hidden);
    const double before = past.noise.trace();
    const ContinuedMotions found = continue_motions(scan, past, kPatches, kShare);
    past = found.sums;
    agreed += past.noise.trace() > before + 0.999 * scan.noise.trace() ? 1 : 0;
    const double single = angle_between(most_hidden(principal_motions(scan)), hidden);
    of_one += single * single / kScans;
    last = angle_between(most_hidden(found.principal), hidden);
  }
  // The other five components of a direction are regressed on m, which has variance 1 in each.
  EXPECT_NEAR(std::sqrt(of_one), kSigma * std::sqrt(5.0 / kPatches), 0.2 * kSigma * std::sqrt(5.0 / kPatches));
  EXPECT_GE(agreed, 85) << "95 in 100 are below the 95 % of chi-squared";
  EXPECT_LT(last, 0.3 * std::sqrt(of_one));
}

TEST(PrincipalMotions, ForgetWhatAScanContradicts) {
  Scans scans(4);
  MotionInformation past;
  for (int k = 0; k < 30; ++k) {
    past = continue_motions(scans.see(turned(0.0)), past, kPatches, kShare).sums;
  }
  const Vector6d now = turned(0.7);
  const MotionInformation scan = scans.see(now);
  const Vector6d found = most_hidden(continue_motions(scan, past, kPatches, kShare).principal);
  EXPECT_LT(angle_between(found, now), 4.0 * kSigma * std::sqrt(5.0 / kPatches));
}

TEST(PrincipalMotions, FollowOneThatTurns) {
  Scans scans(5);
  constexpr int kScans = 200;
  MotionInformation past;
  double followed = 0.0;
  double of_one = 0.0;
  for (int k = 0; k < kScans; ++k) {
    const Vector6d hidden = turned(0.005 * k);
    const MotionInformation scan = scans.see(hidden);
    const ContinuedMotions found = continue_motions(scan, past, kPatches, kShare);
    past = found.sums;
    followed += std::pow(angle_between(most_hidden(found.principal), hidden), 2);
    of_one += std::pow(angle_between(most_hidden(principal_motions(scan)), hidden), 2);
  }
  EXPECT_LT(followed, 1.3 * of_one);
}

TEST(PrincipalMotions, StateInformationOneInTheScan) {
  Scans scans(6);
  const MotionInformation past = scans.see(turned(0.0));
  const MotionInformation scan = scans.see(turned(0.0));
  const Matrix6d motions = continue_motions(scan, past, kPatches, kShare).principal.motions;
  EXPECT_LT(((motions.transpose() * scan.all * motions).diagonal() - Vector6d::Ones()).norm(), 1e-9);
}

}  // namespace
}  // namespace dynamic_icp::window
