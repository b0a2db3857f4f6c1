// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/plane_terms.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "testing/dense_algebra.hpp"
#include "testing/one_thread.hpp"
#include "testing/plane_terms_by_hand.hpp"
#include "testing/swept_room.hpp"

namespace dynamic_icp::window {
namespace {

using namespace by_hand;

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using mapping::PlaneMap;

constexpr double kKnots_s = 0.0125;
constexpr double kSlice_s = kKnots_s / 8.0;
constexpr std::size_t kSlices = 64;

SplineTrajectory true_trajectory() {
  Vector6d reference;
  reference << 0.1, -0.2, 0.5, 1.0, -0.5, 0.3;
  SplineTrajectory trajectory(kKnots_s);
  trajectory.begin(kStamp_s, kStamp_s + kSlices * kSlice_s, exp_se3(reference), Vector3d::Zero(), Vector3d::Zero());
  for (std::size_t k = 0; k < trajectory.coefficients().size(); ++k) {
    const double t = kKnots_s * (static_cast<double>(k) - 1.0);
    trajectory.coefficients()[k] << 0.01 * std::sin(8.0 * t), 0.1 * t, 0.3 * t, 8.0 * t - 5.0 * t * t,
        0.05 * std::sin(7.0 * t), 0.02 * t;
  }
  return trajectory;
}

/// Off by about a centimetre and a milliradian.
SplineTrajectory wrong_trajectory() {
  SplineTrajectory trajectory = true_trajectory();
  for (std::size_t k = 0; k < trajectory.coefficients().size(); ++k) {
    Vector6d off;
    off << 1e-3, -5e-4, 8e-4, 0.01, -0.006, 0.004;
    trajectory.coefficients()[k] += (0.5 + 0.1 * static_cast<double>(k)) * off;
  }
  return trajectory;
}

/// What a sensor on the trajectory sees of a room: each point in the middle of a slice, or at any time.
Scan scan_of(const Room& room, const SplineTrajectory& trajectory, std::size_t count, bool in_slices = true) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  RawScan raw;
  raw.points.emplace_back(0.3, 0.2, 0.1);  // begins the sweep, on no plane
  raw.times.push_back(0.0);
  raw.doppler.push_back(0.0);
  const std::vector<Vector3d> seen = room.points(2, count);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const double slices = in_slices ? static_cast<double>(k * 37 % kSlices) + 0.5 : kSlices * uniform(random);
    raw.times.push_back(slices * kSlice_s);
    raw.points.push_back(trajectory.pose(kStamp_s + raw.times.back()).inverse() * seen[k]);
    raw.doppler.push_back(0.0);
  }
  return Scan::from_raw(raw);
}

struct PlaneTermSums {
  MatrixXd H;
  VectorXd g;
};

/// Of the definition; rigid displacements of the map and of its last sweep are eliminated, both known as well as `held`
/// says of each motion that is principal to information and noise.
PlaneTermSums expected_sums(const Definition& definition, const Vector6d& held) {
  const MatrixXd J = definition.jacobian();
  const auto W = definition.weights.asDiagonal();
  const MatrixXd m = definition.by_rigid_motion();
  const MatrixXd information = m.transpose() * W * m;
  const dense::SymmetricParts parts = dense::symmetric_parts(information);
  const MatrixXd root = parts.vectors * parts.values.cwiseSqrt().asDiagonal() * parts.vectors.transpose();
  const MatrixXd whiten = dense::inverse(root);
  const dense::SymmetricParts shares = dense::symmetric_parts(whiten * definition.noise_of_normals() * whiten);
  const VectorXd expected = (1.0 - shares.values.array() / PlaneNoise().max_noise_share).max(0.0);
  EXPECT_LT((held - expected).cwiseAbs().maxCoeff(), 0.02);
  const MatrixXd motions = root * shares.vectors;
  const VectorXd known = held.array() / (1.0 - held.array());
  MatrixXd both(m.rows(), 12);
  both << m, definition.recent_shares().asDiagonal() * m;
  MatrixXd A = both.transpose() * W * both;
  const MatrixXd prior = motions * known.asDiagonal() * motions.transpose();
  A.topLeftCorner(6, 6) += prior;
  A.bottomRightCorner(6, 6) += prior;
  const VectorXd We = W * definition.residuals();
  const MatrixXd U = J.transpose() * W * both;
  return {J.transpose() * W * J - U * dense::solve(A, U.transpose()),
          J.transpose() * We - U * dense::solve(A, both.transpose() * We)};
}

PlaneTermSums sums_of(const PlaneTerms& terms, const Layout& at) {
  PlaneTermSums sums{MatrixXd::Zero(at.size(), at.size()), VectorXd::Zero(at.size())};
  terms.add(at, sums.H, sums.g);
  sums.H = MatrixXd(sums.H.selfadjointView<Eigen::Lower>());
  return sums;
}

VectorXd some_map_error() {
  VectorXd error(Layout::kMapError);
  for (Index k = 0; k < error.size(); ++k) {
    error[k] = (k % 6 < 3 ? 3e-4 : 0.004) * std::sin(1.7 * static_cast<double>(k) + 0.5);
  }
  return error;
}

/// In units of what each unknown is known to by itself.
void expect_equal(const PlaneTermSums& found, const PlaneTermSums& expected, double tolerance) {
  VectorXd scale(expected.g.size());
  for (Index k = 0; k < scale.size(); ++k) {
    scale[k] = expected.H(k, k) > 1e-3 ? 1.0 / std::sqrt(expected.H(k, k)) : 0.0;
  }
  const MatrixXd off = scale.asDiagonal() * (found.H - expected.H) * scale.asDiagonal();
  const VectorXd g = scale.cwiseProduct(expected.g);
  EXPECT_LT(off.cwiseAbs().maxCoeff(), tolerance);
  EXPECT_LT((scale.cwiseProduct(found.g) - g).cwiseAbs().maxCoeff(), tolerance * g.cwiseAbs().maxCoeff());
  EXPECT_LT((found.H - found.H.transpose()).norm(), 1e-9 * found.H.norm());
}

TEST(PlaneTerms, AreTheSumsOfTheirEquation) {
  for (const bool has_ends : {true, false}) {
    Room room;
    room.has_ends = has_ends;
    const PlaneMap map = room.map();
    const Scan scan = scan_of(room, true_trajectory(), 1000);
    for (const bool adapt : {false, true}) {
      PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
      terms.associate(wrong_trajectory(), some_map_error(), {}, adapt);
      const Definition definition(scan, map, wrong_trajectory(), some_map_error(), {}, adapt);
      // Off by the map error times how X depends on the motion, a few 1e-4.
      expect_equal(sums_of(terms, definition.layout()), expected_sums(definition, terms.quality().held), 2e-3);
      EXPECT_EQ(sums_of(terms, definition.layout()).g.head(3).norm(), 0.0) << "nothing of the Doppler's error";
      EXPECT_EQ(sums_of(terms, definition.layout()).g[definition.layout().last_stamp()], 0.0);
    }
  }
}

TEST(PlaneTerms, APatchErrsAsTheSweepsOfItsAge) {
  for (const bool has_ends : {true, false}) {
    Room room;
    room.has_ends = has_ends;
    PlaneMap map = room.map(20000);
    const std::vector<Vector3d> again = room.points(7, 20000);
    std::vector<Vector3d> near_by;
    std::ranges::copy_if(again, std::back_inserter(near_by), [](const Vector3d& point) { return point.x() > 0.0; });
    const std::vector<double> phases(near_by.size(), 0.3);
    for (int k = 0; k < 3; ++k) {
      map.add(near_by, Vector3d::Zero(), kOneThread, phases);
    }
    const Scan scan = scan_of(room, true_trajectory(), 1000);
    LastSweep last;
    last.map_age = 2.2;
    last.displacement << 3e-4, -2e-4, 5e-4, 0.003, -0.005, 0.002;
    const auto count = static_cast<Index>(true_trajectory().coefficients().size());
    last.rows = MatrixXd::NullaryExpr(6, 6 * count, [](Index i, Index k) {
      return 0.3 * std::sin(1.1 * static_cast<double>(i) + 2.3 * static_cast<double>(k)) /
             (1.0 + static_cast<double>(k));
    });
    PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
    terms.set_last_sweep(last);
    terms.associate(wrong_trajectory(), some_map_error(), {}, false);
    const Definition definition(scan, map, wrong_trajectory(), some_map_error(), {}, false, Matrix6d::Zero(), last);
    expect_equal(sums_of(terms, definition.layout()), expected_sums(definition, terms.quality().held), 2e-3);
  }
}

TEST(PlaneTerms, ATurnThatIsUnknownRejectsNoWall) {
  // Floor and ceiling fit at any yaw, walls only near the true one.
  const Room room;
  const PlaneMap map = room.map();
  const Scan scan = scan_of(room, true_trajectory(), 1000);
  SplineTrajectory turned = true_trajectory();
  for (Vector6d& coefficient : turned.coefficients()) {
    coefficient[2] += 0.03;
  }
  Matrix6d unknown = Matrix6d::Zero();
  unknown(2, 2) = 0.03 * 0.03;
  const VectorXd no_error = VectorXd::Zero(Layout::kMapError);
  PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
  terms.associate(turned, no_error, {}, false);
  const PlaneQuality believed = terms.quality();
  terms.associate(turned, no_error, {}, false, std::vector<Matrix6d>(terms.slice_times().size(), unknown));
  const PlaneQuality open = terms.quality();
  EXPECT_LT(believed.matched, 0.6 * static_cast<double>(believed.on_planes));
  EXPECT_GT(open.matched, 0.8 * static_cast<double>(open.on_planes));
  const Definition definition(scan, map, turned, no_error, {}, false, unknown);
  EXPECT_NEAR(open.matched, definition.robust.sum(), 1e-3 * open.matched);
}

TEST(PlaneTerms, TellHowWellThePointsFit) {
  const Room room;
  const PlaneMap map = room.map();
  const Scan scan = scan_of(room, true_trajectory(), 3000);
  PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
  terms.associate(wrong_trajectory(), some_map_error(), {}, true);
  const Definition definition(scan, map, wrong_trajectory(), some_map_error(), {}, true);
  const PlaneQuality quality = terms.quality();
  EXPECT_EQ(quality.on_planes, scan.size() - static_cast<std::size_t>(std::count(definition.patches.begin(),
                                                                                 definition.patches.end(), nullptr)));
  EXPECT_GT(quality.on_planes, 2500U);
  EXPECT_NEAR(quality.matched, definition.robust.sum(), 1e-3 * quality.matched);
  // Points of the scan against those of the map, 3000 to 40000, everywhere.
  EXPECT_NEAR(quality.share, 3.0 / 43.0, 0.01);
  const double squares = definition.robust.dot(definition.residuals().cwiseAbs2());
  EXPECT_NEAR(quality.rms_m, std::sqrt(squares / definition.robust.sum()), 1e-3 * quality.rms_m);
}

TEST(PlaneTerms, PlacePointsAtTheirOwnTimes) {
  // Exact planes, exact points at any time: what is left is the straight step over half a slice.
  Room room;
  room.noise_m = 0.0;
  const PlaneMap map = room.map();
  const Scan scan = scan_of(room, true_trajectory(), 5000, false);
  PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
  terms.associate(true_trajectory(), VectorXd::Zero(Layout::kMapError), {}, false);
  EXPECT_GT(terms.quality().matched, 4000.0);
  EXPECT_LT(terms.quality().rms_m, 1e-5);
}

TEST(PlaneTerms, AStampCanBeSetAnew) {
  const Room room;
  const PlaneMap map = room.map();
  const Scan scan = scan_of(room, true_trajectory(), 3000);
  PlaneTerms moved(scan, map, kStamp_s + 0.002, kSlice_s, kOneThread);
  moved.set_stamp(kStamp_s);
  moved.associate(true_trajectory(), some_map_error(), {}, false);
  PlaneTerms made(scan, map, kStamp_s, kSlice_s, kOneThread);
  made.associate(true_trajectory(), some_map_error(), {}, false);
  const Definition definition(scan, map, true_trajectory(), some_map_error(), {}, false);
  expect_equal(sums_of(moved, definition.layout()), sums_of(made, definition.layout()), 1e-9);
}

TEST(PlaneTerms, OneStepFindsTheMotion) {
  // With every coefficient free only what all of them share is well known: a rigid displacement.
  const Room room;
  const PlaneMap map = room.map();
  const Scan scan = scan_of(room, true_trajectory(), 6000);
  SplineTrajectory displaced = true_trajectory();
  for (Vector6d& c : displaced.coefficients()) {
    c[3] += 0.01;
    c[4] -= 0.008;
    c[5] += 0.005;
  }
  PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
  terms.associate(displaced, VectorXd::Zero(Layout::kMapError), {}, true);
  const Layout at{0, static_cast<Index>(displaced.coefficients().size())};
  const PlaneTermSums sums = sums_of(terms, at);
  MatrixXd B = MatrixXd::Zero(at.size(), 6);
  for (std::size_t k = 0; k < displaced.coefficients().size(); ++k) {
    B.block(at.coefficient(k), 0, 6, 6).setIdentity();
  }
  const MatrixXd H = B.transpose() * sums.H * B;
  const Vector6d step = -dense::solve(H, B.transpose() * sums.g);
  EXPECT_LT((step.tail<3>() - Vector3d(-0.01, 0.008, -0.005)).norm(), 1e-3);
  EXPECT_LT(step.head<3>().norm(), 2e-4);
}

TEST(PlaneTerms, LearnHowRoughSurfacesAre) {
  // A piece of wall of two metres is a centimetre off in the map, each by itself; seen are flat walls.
  Room rough;
  rough.patch_sigma_m = 0.01;
  const PlaneMap map = rough.map();
  PlaneNoise noise;
  noise.model_sigma_m = 0.01;
  for (const double rigid_m : {0.0, 0.02}) {
    SplineTrajectory trajectory = true_trajectory();
    for (Vector6d& c : trajectory.coefficients()) {
      c[3] += rigid_m;
    }
    const Scan scan = scan_of(Room{}, true_trajectory(), 6000);
    PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
    terms.associate(trajectory, VectorXd::Zero(Layout::kMapError), noise, true);
    ASSERT_TRUE(terms.quality().model_sigma_m);
    EXPECT_NEAR(*terms.quality().model_sigma_m, 0.01, 0.003) << "displaced by " << rigid_m;
    const PlaneMap flat = Room{}.map();
    PlaneTerms on_flat(scan, flat, kStamp_s, kSlice_s, kOneThread);
    on_flat.associate(trajectory, VectorXd::Zero(Layout::kMapError), {}, true);
    ASSERT_TRUE(on_flat.quality().model_sigma_m);
    EXPECT_LT(*on_flat.quality().model_sigma_m, 0.002) << "displaced by " << rigid_m;
  }
}

TEST(PlaneTerms, WithoutAMapAddNothing) {
  const PlaneMap map({});
  const Scan scan = scan_of(Room{}, true_trajectory(), 300);
  PlaneTerms terms(scan, map, kStamp_s, kSlice_s, kOneThread);
  terms.associate(true_trajectory(), VectorXd::Zero(Layout::kMapError), {}, true);
  const Layout at{3, static_cast<Index>(true_trajectory().coefficients().size())};
  const PlaneTermSums sums = sums_of(terms, at);
  EXPECT_EQ(sums.H.norm(), 0.0);
  EXPECT_EQ(sums.g.norm(), 0.0);
  const PlaneQuality quality = terms.quality();
  EXPECT_EQ(quality.on_planes, 0U);
  EXPECT_EQ(quality.matched, 0.0);
  EXPECT_EQ(quality.rms_m, 0.0);
  EXPECT_FALSE(quality.model_sigma_m);
}

}  // namespace
}  // namespace dynamic_icp::window
