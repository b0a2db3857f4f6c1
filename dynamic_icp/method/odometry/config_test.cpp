// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <set>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::odometry {
namespace {

TEST(OdometryConfig, PresetPaperHasThePublishedValues) {
  // The table of the paper's implementation section and of its authors' program.
  const Config paper = preset("paper");
  EXPECT_EQ(paper.preprocess.voxel.voxel_size_m, 0.3);
  EXPECT_EQ(paper.preprocess.range.min_range_m, 0.2);
  EXPECT_EQ(paper.preprocess.range.max_range_m, 400.0);
  EXPECT_EQ(paper.preprocess.normals.radius_m, 2.0);
  EXPECT_EQ(paper.preprocess.normals.max_neighbours, 30);
  EXPECT_EQ(paper.ego_motion.regression.huber_delta_mps, 0.3);
  EXPECT_EQ(paper.ego_motion.regression.max_iterations, 50);
  EXPECT_EQ(paper.ego_motion.filter.tau_0_mps, 0.35);
  EXPECT_EQ(paper.ego_motion.filter.kappa_per_s, 0.005);
  EXPECT_EQ(paper.dynamics.clustering.min_cluster_size, 30);
  EXPECT_EQ(paper.dynamics.clustering.min_samples, 10);
  EXPECT_EQ(paper.dynamics.velocity.lambda, 0.05);
  EXPECT_EQ(paper.dynamics.velocity.min_inlier_fraction, 0.5);
  EXPECT_EQ(paper.dynamics.velocity.min_singular_value, 1e-3);
  EXPECT_EQ(paper.dynamics.velocity.max_condition_number, 400.0);
  EXPECT_EQ(paper.registration.doppler_weight, 0.2);
  EXPECT_EQ(paper.registration.tukey_geometry_m, 0.5);
  EXPECT_EQ(paper.registration.tukey_doppler_mps, 0.3);
  EXPECT_EQ(paper.registration.max_correspondence_distance_m, 0.3);
  EXPECT_EQ(paper.registration.max_iterations, 100);
  EXPECT_EQ(paper.registration.tolerance, 1e-5);
}

TEST(OdometryConfig, EveryFieldHasItsOwnKeyAndPassesItsOwnCheck) {
  Config config;
  std::set<std::string> keys;
  for (const ConfigField& field : fields(config)) {
    EXPECT_TRUE(keys.insert(field.key).second) << field.key;
    EXPECT_FALSE(field.description.empty()) << field.key;
    EXPECT_NO_THROW(set_field(fields(config), field.key, value_text(field))) << field.key;
  }
  EXPECT_NO_THROW(check(config));
}

TEST(OdometryConfig, ValuesThatDoNotGoTogetherAreRefused) {
  Config config;
  config.preprocess.range.min_range_m = 500.0;
  EXPECT_THROW(check(config), UsageError);
  config = Config{};
  config.preprocess.voxel.voxel_size_m = 1e-5;
  EXPECT_THROW(check(config), UsageError);
  config.preprocess.voxel.voxel_size_m = 0.0;
  EXPECT_NO_THROW(check(config));
}

TEST(OdometryConfig, AblationsSwitchOffWhatThePaperSwitchesOff) {
  Config config;
  apply_ablation(config, "no-vf");
  EXPECT_FALSE(config.ego_motion.filter.enabled);
  config = Config{};
  apply_ablation(config, "no-dpp");
  EXPECT_FALSE(config.dynamics.predict);
  config = Config{};
  apply_ablation(config, "no-dr");
  EXPECT_EQ(config.registration.doppler_weight, 0.0);
  EXPECT_NO_THROW(apply_ablation(config, "none"));
  EXPECT_THROW(apply_ablation(config, "no-such"), UsageError);
  EXPECT_THROW(preset("best"), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::odometry
