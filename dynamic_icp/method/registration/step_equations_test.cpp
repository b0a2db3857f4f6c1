// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/step_equations.hpp"

#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "dynamic_icp/method/registration/correspondences.hpp"

namespace dynamic_icp::registration {
namespace {

class Cloud {
 public:
  Cloud(unsigned seed, std::size_t n) : random_(seed) {
    RawScan raw;
    for (std::size_t i = 0; i < n; ++i) {
      raw.points.push_back(4.0 * vector());
      raw.doppler.push_back(0.5 * uniform_(random_));
      normals.push_back(vector().normalized());
      has_normal.push_back(i % 9 == 0 ? 0 : 1);
    }
    scan = Scan::from_raw(raw);
  }
  Eigen::Vector3d vector() { return {uniform_(random_), uniform_(random_), uniform_(random_)}; }

  Scan scan;
  std::vector<Eigen::Vector3d> normals;
  std::vector<std::uint8_t> has_normal;

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> uniform_{-1.0, 1.0};
};

TEST(StepEquations, AreThoseOfTheGeneralLinearisation) {
  const Workers workers(1);
  for (const std::size_t n : {3u, 400u, 2001u}) {
    Cloud source(1, n);
    const Cloud target_cloud(2, 3000);
    const spatial::KdTree tree(target_cloud.scan.points());
    const Target target{target_cloud.scan, tree, target_cloud.normals, target_cloud.has_normal};
    CorrespondenceSearch search(source.scan, target, Gate{0.5}, true, workers);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (const double tukey : {0.2, 1.0, std::numeric_limits<double>::infinity()}) {
      for (const double weight : {0.0, 0.2, 0.7}) {
        T = Eigen::AngleAxisd(0.02, source.vector().normalized()) * T;
        T.pretranslate(0.1 * source.vector());
        Objective objective;
        objective.tukey_geometry_m = tukey;
        objective.tukey_doppler_mps = 2.0 * tukey;
        objective.doppler_weight = weight;
        ASSERT_TRUE(has_step_equations(objective));
        const Correspondences pairs = search.find(T);
        const Linearisation slow = linearise({{source.scan}, target, pairs}, T, objective, 0, workers);
        const StepEquations fast = step_equations(search.groups(), T.linear(), objective);
        EXPECT_EQ(fast.pairs, pairs.pairs.size());
        const Fit fit = fit_of(fast.pairs, fast.squared_distances, n);
        EXPECT_NEAR(fit.fitness, pairs.fitness, 1e-15);
        EXPECT_NEAR(fit.inlier_rmse, pairs.inlier_rmse, 1e-14);
        const Matrix6d H = slow.equations.H.triangularView<Eigen::Lower>();
        EXPECT_GT(n < 10 ? 1.0 : H.norm(), 0.0);
        EXPECT_LE((fast.equations.H - H).norm(), 1e-13 * H.norm());
        EXPECT_LE((fast.equations.b - slow.equations.b).norm(), 1e-13 * H.norm());
      }
    }
  }
}

TEST(StepEquations, KnowWhatTheyCannotDo) {
  Objective objective;
  EXPECT_TRUE(has_step_equations(objective));
  objective.doppler = DopplerTerm::kNone;
  EXPECT_TRUE(has_step_equations(objective));
  objective.doppler = DopplerTerm::kSensorVelocity;
  EXPECT_FALSE(has_step_equations(objective));
  objective = {};
  objective.tukey_doppler_from_iteration = 1;
  EXPECT_FALSE(has_step_equations(objective));
  objective = {};
  objective.reject_doppler_mps = 2.0;
  EXPECT_FALSE(has_step_equations(objective));
  for (const GeometryTerm geometry : {GeometryTerm::kPointToPoint, GeometryTerm::kPlaneToPlane}) {
    objective = {};
    objective.geometry = geometry;
    EXPECT_FALSE(has_step_equations(objective));
  }
}

}  // namespace
}  // namespace dynamic_icp::registration
