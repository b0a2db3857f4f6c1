// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/align.hpp"

#include <limits>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "dynamic_icp/method/estimation/robust_kernel.hpp"
#include "dynamic_icp/method/registration/objective.hpp"

#include "testing/dense_algebra.hpp"

namespace dynamic_icp::registration {
namespace {

using Eigen::Vector3d;

/// Points on the six faces of a room of 10 x 8 x 4 m around the sensor, with the exact normals of the faces.
struct Room {
  explicit Room(unsigned seed, std::size_t n, double noise_m = 0.0, bool floor_only = false) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::normal_distribution<double> normal;
    RawScan raw;
    for (std::size_t i = 0; i < n; ++i) {
      const int axis = floor_only ? 2 : static_cast<int>(i % 3);
      const double side = floor_only || (i / 3) % 2 == 0 ? -1.0 : 1.0;
      Vector3d p = Vector3d(5.0 * uniform(random), 4.0 * uniform(random), 2.0 * uniform(random));
      p[axis] = side * Vector3d(5.0, 4.0, 2.0)[axis] + noise_m * normal(random);
      raw.points.push_back(p);
      raw.doppler.push_back(-p.normalized().dot(velocity));
      normals.push_back(-side * Vector3d::Unit(axis));
    }
    scan = Scan::from_raw(raw);
    has_normal.assign(n, 1);
    tree.emplace(scan.points());
  }

  [[nodiscard]] Target target() const { return {scan, *tree, normals, has_normal}; }

  /// The same room seen after the motion, in the frame from which T leads back to the room.
  [[nodiscard]] Scan moved(const Eigen::Isometry3d& T_room_source) const {
    RawScan raw;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      raw.points.push_back(T_room_source.inverse() * scan.points()[i]);
      raw.doppler.push_back(-raw.points.back().normalized().dot(velocity));
    }
    return Scan::from_raw(raw);
  }

  Vector3d velocity{3.0, 0.5, 0.0};
  Scan scan;
  std::vector<Vector3d> normals;
  std::vector<std::uint8_t> has_normal;
  std::optional<spatial::KdTree> tree;
};

Eigen::Isometry3d motion(double angle, double distance) {
  Vector6d xi;
  xi << angle * Vector3d(0.3, -0.5, 0.8).normalized(), distance * Vector3d(1.0, 0.4, -0.2).normalized();
  return exp_se3(xi);
}

double translation_error(const Eigen::Isometry3d& A, const Eigen::Isometry3d& B) {
  return (A.inverse() * B).translation().norm();
}

TEST(Align, RecoversAMotionExactlyWithoutNoise) {
  const Room room(1, 6000);
  const Eigen::Isometry3d T = motion(0.01, 0.1);
  AlignConfig config;
  config.doppler_weight = 0.0;
  config.tolerance = 1e-9;
  const Alignment result = align(room.moved(T), room.target(), Eigen::Isometry3d::Identity(), config, Workers(2));
  EXPECT_EQ(result.status, AlignStatus::kConverged);
  EXPECT_LT(translation_error(T, result.T_target_source), 1e-9);
  EXPECT_LT(rotation_angle(T.linear().transpose() * result.T_target_source.linear()), 1e-9);
  EXPECT_EQ(result.fitness, 1.0);
  EXPECT_EQ(result.geometry.count, result.correspondences);
  EXPECT_TRUE(result.degenerate.empty());
  ASSERT_TRUE(result.covariance.has_value());
}

TEST(Align, TheDopplerTermHardlyDisturbsGoodGeometry) {
  // Where the sensor turned between the scans, s_i R u_i and s_j u_j differ although nothing is wrong: the velocity is
  // constant in the turning sensor frame, not in space. The term pulls a little.
  const Room room(1, 6000);
  const Eigen::Isometry3d T = motion(0.01, 0.1);
  const Alignment result = align(room.moved(T), room.target(), Eigen::Isometry3d::Identity(), {}, Workers(2));
  EXPECT_EQ(result.status, AlignStatus::kConverged);
  EXPECT_EQ(result.doppler.count, result.correspondences);
  EXPECT_LT(translation_error(T, result.T_target_source), 1e-4);
  EXPECT_LT(rotation_angle(T.linear().transpose() * result.T_target_source.linear()), 1e-4);
}

TEST(Align, FirstStepIsTheWeightedLeastSquaresStep) {
  const Workers workers(1);
  // One Gauss-Newton step against the same rows stacked and solved by an orthogonal decomposition.
  const Room room(2, 900, 0.05);
  const Scan source = room.moved(motion(0.005, 0.05));
  AlignConfig config;
  config.max_iterations = 1;
  const Eigen::Isometry3d T0 = Eigen::Isometry3d::Identity();
  const Correspondences pairs = CorrespondenceSearch(source, room.target(), Gate{0.3}, true, workers).find(T0);
  Eigen::Matrix<double, Eigen::Dynamic, 6> A(2 * static_cast<Eigen::Index>(pairs.pairs.size()), 6);
  Eigen::VectorXd b(A.rows());
  Eigen::Index row = 0;
  for (const Correspondence& pair : pairs.pairs) {
    const Vector3d p = source.points()[pair.source];
    const Vector3d n = room.normals[pair.target];
    const double rg = n.dot(p - room.scan.points()[pair.target]);
    const double wg = std::sqrt(0.8 * estimation::tukey_weight(rg, 0.5));
    A.row(row) << wg * p.cross(n).transpose(), wg * n.transpose();
    b[row++] = -wg * rg;
    const Vector3d ray = source.doppler()[pair.source] * source.directions()[pair.source];
    const Vector3d u = room.scan.directions()[pair.target];
    const double rv = u.dot(ray) - room.scan.doppler()[pair.target];
    const double wv = std::sqrt(0.2 * estimation::tukey_weight(rv, 0.3));
    A.row(row) << wv * ray.cross(u).transpose(), 0.0, 0.0, 0.0;
    b[row++] = -wv * rv;
  }
  const Alignment result = align(source, room.target(), T0, config, Workers(1));
  EXPECT_EQ(result.iterations, 1);
  EXPECT_LT((log_se3(result.T_target_source) - dense::least_squares(A, b)).norm(), 1e-10);
}

/// The paper's objective, Eq. (14), with its weights and scales.
double cost(const Scan& source, const Target& target, const Correspondences& correspondences,
            const Eigen::Isometry3d& T) {
  double sum = 0.0;
  for (const Correspondence& pair : correspondences.pairs) {
    const Vector3d p = T * source.points()[pair.source];
    const Vector3d ray = T.linear() * (source.doppler()[pair.source] * source.directions()[pair.source]);
    const double r_g = target.normals[pair.target].dot(p - target.scan.points()[pair.target]);
    const double r_v = target.scan.directions()[pair.target].dot(ray) - target.scan.doppler()[pair.target];
    sum += 0.8 * estimation::tukey_loss(r_g, 0.5) + 0.2 * estimation::tukey_loss(r_v, 0.3);
  }
  return sum;
}

TEST(Align, CostDoesNotChangeWhenBothScansAreTurned) {
  const Workers workers(1);
  const Room room(3, 600, 0.03);
  const Eigen::Isometry3d T = motion(0.02, 0.1);
  const Scan source = room.moved(T);
  const Correspondences pairs = CorrespondenceSearch(source, room.target(), Gate{0.3}, true, workers).find(T);
  const double expected = cost(source, room.target(), pairs, T);
  Vector6d rotation;
  rotation << 0.4, -1.1, 0.7, 0.0, 0.0, 0.0;
  const Eigen::Isometry3d Q = exp_se3(rotation);
  const Scan turned_scan = room.scan.transformed(Q);
  const spatial::KdTree tree(turned_scan.points());
  std::vector<Vector3d> normals = room.normals;
  for (Vector3d& n : normals) {
    n = Q.linear() * n;
  }
  const Target target{turned_scan, tree, normals, room.has_normal};
  EXPECT_NEAR(cost(source.transformed(Q), target, pairs, Q * T * Q.inverse()), expected, 1e-10 * expected);
}

TEST(Align, NormalEquationsAreTheGradientOfTheCost) {
  const Workers workers(1);
  const Room room(4, 600, 0.05);
  const Scan source = room.moved(motion(0.01, 0.1));
  const Eigen::Isometry3d T = motion(0.012, 0.12);
  const Correspondences pairs = CorrespondenceSearch(source, room.target(), Gate{0.5}, true, workers).find(T);
  const Linearisation linear = linearise({{source}, room.target(), pairs}, T, {}, 0, Workers(1));
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = 1e-6 * Vector6d::Unit(k);
    const double slope = (cost(source, room.target(), pairs, exp_se3(step) * T) -
                          cost(source, room.target(), pairs, exp_se3(-step) * T)) /
                         2e-6;
    EXPECT_NEAR(linear.equations.b[k], slope, 1e-4 * (1.0 + std::abs(slope))) << "component " << k;
  }
}

TEST(Align, WithoutDopplerWeightTheTermIsOff) {
  const Room room(5, 600);
  AlignConfig config;
  config.doppler_weight = 0.0;
  const Alignment result =
      align(room.moved(motion(0.0, 0.05)), room.target(), Eigen::Isometry3d::Identity(), config, Workers(1));
  EXPECT_EQ(result.doppler.count, 0u);
  EXPECT_GT(result.geometry.count, 500u);
}

TEST(Align, OnePlaneIsReportedAsDegenerate) {
  const Room room(6, 2000, 0.0, true);
  AlignConfig config;
  config.doppler_weight = 0.0;
  const Alignment result = align(room.scan, room.target(), Eigen::Isometry3d::Identity(), config, Workers(1));
  EXPECT_EQ(result.status, AlignStatus::kDegenerate);
  ASSERT_EQ(result.degenerate.size(), 3u) << "two translations along the plane and the rotation about its normal";
  for (const estimation::DegenerateDirection& open : result.degenerate) {
    EXPECT_NEAR(open.direction[0], 0.0, 1e-6);
    EXPECT_NEAR(open.direction[1], 0.0, 1e-6);
    EXPECT_NEAR(open.direction[5], 0.0, 1e-6);
  }
  EXPECT_FALSE(result.covariance.has_value());
  EXPECT_TRUE(result.T_target_source.matrix().allFinite());
}

TEST(Align, NothingToAlignIsAStatus) {
  const Room room(7, 300);
  const Room nothing(8, 0);
  const Eigen::Isometry3d far = motion(0.0, 500.0);
  for (const Alignment& result :
       {align(Scan{}, room.target(), far, {}, Workers(1)), align(room.scan, nothing.target(), far, {}, Workers(1)),
        align(room.scan, room.target(), far, {}, Workers(1))}) {
    EXPECT_EQ(result.status, AlignStatus::kTooFewCorrespondences);
    EXPECT_LT(translation_error(result.T_target_source, far), 1e-9) << "the start is kept";
    EXPECT_EQ(result.fitness, 0.0);
    EXPECT_FALSE(result.covariance.has_value());
  }
  EXPECT_EQ(Alignment{}.status, AlignStatus::kNotRun);
}

TEST(Align, StopsAtTheIterationLimit) {
  const Room room(9, 3000, 0.02);
  AlignConfig config;
  config.max_iterations = 2;
  config.tolerance = 1e-12;
  const Alignment result =
      align(room.moved(motion(0.02, 0.2)), room.target(), Eigen::Isometry3d::Identity(), config, Workers(1));
  EXPECT_EQ(result.status, AlignStatus::kIterationLimit);
  EXPECT_EQ(result.iterations, 2);
}

TEST(Align, CovarianceCoversTheErrorOfIndependentResiduals) {
  // Source noise on exact planes: the residuals are independent, so the normalised error squared has mean 6.
  const Room room(10, 3000);
  const Eigen::Isometry3d T = motion(0.005, 0.05);
  AlignConfig config;
  config.doppler_weight = 0.0;
  double sum = 0.0;
  constexpr int kRepeats = 60;
  for (unsigned seed = 0; seed < kRepeats; ++seed) {
    std::mt19937 random(1000 + seed);
    std::normal_distribution<double> normal;
    const Scan exact = room.moved(T);
    RawScan raw;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      raw.points.push_back(exact.points()[i] + 0.01 * Vector3d(normal(random), normal(random), normal(random)));
      raw.doppler.push_back(0.0);
    }
    const Alignment result = align(Scan::from_raw(raw), room.target(), T, config, Workers(1));
    ASSERT_TRUE(result.covariance.has_value());
    const Vector6d error = log_se3(result.T_target_source * T.inverse());
    sum += error.dot(result.covariance->inverse() * error);
  }
  EXPECT_NEAR(sum / kRepeats, 6.0, 2.0);
}

TEST(Align, SameBitsForAnyNumberOfThreads) {
  const Room room(11, 8000, 0.02);
  const Scan source = room.moved(motion(0.01, 0.15));
  const Alignment one = align(source, room.target(), Eigen::Isometry3d::Identity(), {}, Workers(1));
  for (const int threads : {2, 7}) {
    const Alignment several = align(source, room.target(), Eigen::Isometry3d::Identity(), {}, Workers(threads));
    EXPECT_EQ(one.T_target_source.matrix(), several.T_target_source.matrix());
    EXPECT_EQ(*one.covariance, *several.covariance);
    EXPECT_EQ(one.iterations, several.iterations);
  }
}

/// Minimises one geometry term by least squares.
Alignment align_by(GeometryTerm term, const Room& room, const Scan& source, const std::vector<Vector3d>& normals,
                   const Eigen::Isometry3d& T_initial) {
  Objective objective;
  objective.geometry = term;
  objective.doppler = DopplerTerm::kNone;
  objective.tukey_geometry_m = std::numeric_limits<double>::infinity();
  return align({source, normals, room.has_normal}, room.target(), T_initial, objective, {200, 1e-12}, Workers(2));
}

std::vector<Vector3d> rotated(const std::vector<Vector3d>& normals, const Eigen::Matrix3d& R) {
  std::vector<Vector3d> result;
  for (const Vector3d& normal : normals) {
    result.push_back(R * normal);
  }
  return result;
}

TEST(AlignTerms, EveryGeometryTermRecoversTheMotionOfTheSamePoints) {
  const Room room(1, 6000);
  const Eigen::Isometry3d T = motion(0.004, 0.05);
  const std::vector<Vector3d> normals = rotated(room.normals, T.linear().transpose());
  for (const GeometryTerm term :
       {GeometryTerm::kPointToPoint, GeometryTerm::kPointToPlane, GeometryTerm::kPlaneToPlane}) {
    const Alignment result = align_by(term, room, room.moved(T), normals, Eigen::Isometry3d::Identity());
    EXPECT_EQ(result.status, AlignStatus::kConverged);
    EXPECT_LT(translation_error(result.T_target_source, T), 1e-7) << static_cast<int>(term);
    EXPECT_LT(rotation_angle(result.T_target_source.linear().transpose() * T.linear()), 1e-7);
    EXPECT_EQ(result.doppler.count, 0U);
  }
}

TEST(AlignTerms, PointToPointEndsWhereTheClosedFormDoes) {
  // At a fixed point the pairs do not change, and the least squares over them has Umeyama's solution.
  const Room room(1, 3000, 0.01);
  const Room other(2, 3000, 0.01);
  const Scan source = other.moved(motion(0.003, 0.03));
  const Alignment result =
      align_by(GeometryTerm::kPointToPoint, room, source, other.normals, Eigen::Isometry3d::Identity());
  ASSERT_EQ(result.status, AlignStatus::kConverged);
  const Workers workers(1);
  const Correspondences pairs =
      CorrespondenceSearch(source, room.target(), Gate{0.3}, false, workers).find(result.T_target_source);
  Eigen::Matrix3Xd from(3, pairs.pairs.size());
  Eigen::Matrix3Xd to(3, pairs.pairs.size());
  for (std::size_t k = 0; k < pairs.pairs.size(); ++k) {
    from.col(static_cast<Eigen::Index>(k)) = source.points()[pairs.pairs[k].source];
    to.col(static_cast<Eigen::Index>(k)) = room.scan.points()[pairs.pairs[k].target];
  }
  const Eigen::Isometry3d expected = dense::rigid_motion(from, to);
  EXPECT_LT(translation_error(result.T_target_source, expected), 1e-6);
  EXPECT_LT(rotation_angle(result.T_target_source.linear().transpose() * expected.linear()), 1e-6);
}

TEST(AlignTerms, GicpGradientIsTheSlopeOfItsCost) {
  const Room room(1, 600, 0.02);
  const Eigen::Isometry3d T = motion(0.01, 0.05);
  const Scan scan = room.moved(T);
  const std::vector<Vector3d> normals = rotated(room.normals, T.linear().transpose());
  const Source source{scan, normals, room.has_normal};
  Objective objective;
  objective.geometry = GeometryTerm::kPlaneToPlane;
  objective.doppler = DopplerTerm::kNone;
  objective.tukey_geometry_m = std::numeric_limits<double>::infinity();
  const Workers workers(1);
  const Correspondences pairs = CorrespondenceSearch(scan, room.target(), Gate{0.3}, false, workers).find(T);
  const Linearisation linear = linearise({source, room.target(), pairs}, T, objective, 0, workers);
  // 1/2 sum e^T W e with the weights W held at T, as Gauss-Newton does.
  const auto cost_at = [&](const Eigen::Isometry3d& X) {
    double sum = 0.0;
    for (const Correspondence& pair : pairs.pairs) {
      const Vector3d e = X * scan.points()[pair.source] - room.scan.points()[pair.target];
      Eigen::Matrix3d C = 2.0 * Eigen::Matrix3d::Identity();
      const Vector3d n_source = T.linear() * normals[pair.source];
      const Vector3d& n_target = room.normals[pair.target];
      C -= 0.999 * (n_source * n_source.transpose() + n_target * n_target.transpose());
      sum += 0.5 * e.dot(C.inverse() * e);
    }
    return sum;
  };
  for (int k = 0; k < 6; ++k) {
    const Vector6d step = 1e-6 * Vector6d::Unit(k);
    const double slope = (cost_at(exp_se3(step) * T) - cost_at(exp_se3(-step) * T)) / 2e-6;
    EXPECT_NEAR(linear.equations.b[k], slope, 1e-5 * (1.0 + std::abs(slope)));
  }
}

TEST(AlignTerms, PairsWithAWrongDopplerAreRejectedFromTheGivenIterationOn) {
  const Room room(1, 300);
  RawScan raw;
  raw.points = room.scan.points();
  raw.doppler = room.scan.doppler();
  for (std::size_t i = 0; i < 100; ++i) {
    raw.doppler[i] += 10.0;
  }
  const Scan scan = Scan::from_raw(raw);
  const Source source{scan};
  Objective objective;
  objective.doppler = DopplerTerm::kSensorVelocity;
  objective.vehicle.dt_s = 0.1;
  objective.reject_doppler_mps = 2.0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = -0.1 * room.velocity;  // the motion that the Doppler tells
  const Workers workers(1);
  Correspondences pairs;
  for (std::uint32_t i = 0; i < 300; ++i) {
    pairs.pairs.push_back({i, i, 0.0});
  }
  EXPECT_EQ(linearise({source, room.target(), pairs}, T, objective, 1, workers).geometry.count, 300U);
  EXPECT_EQ(linearise({source, room.target(), pairs}, T, objective, 2, workers).geometry.count, 200U);
  EXPECT_EQ(linearise({source, room.target(), pairs}, T, objective, 2, workers).doppler.count, 200U);
}

TEST(AlignTerms, MissingNormalsAndImpossibleObjectivesAreRefused) {
  const Room room(1, 300);
  const auto run = [&](const Objective& objective, const Target& target) {
    (void)align(Source{room.scan}, target, Eigen::Isometry3d::Identity(), objective, {}, Workers(1));
  };
  Objective objective;
  const Target bare{room.scan, *room.tree, {}, {}};
  EXPECT_THROW(run(objective, bare), std::invalid_argument);
  objective.geometry = GeometryTerm::kPlaneToPlane;
  EXPECT_THROW(run(objective, room.target()), std::invalid_argument) << "the source has no normals";
  objective.geometry = GeometryTerm::kPointToPoint;
  EXPECT_NO_THROW(run(objective, bare));
  objective.doppler = DopplerTerm::kSensorVelocity;
  objective.vehicle.dt_s = 0.0;
  EXPECT_THROW(run(objective, bare), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::registration
