// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"

namespace dynamic_icp::odometry {
namespace {

TEST(OdometryConfig, PresetPaperHasThePublishedValues) {
  // The table of the paper's implementation section and of its authors' program.
  const PaperConfig paper;
  EXPECT_EQ(paper.preprocess.voxel.voxel_size_m, 0.3);
  EXPECT_EQ(paper.preprocess.range.min_range_m, 0.2);
  EXPECT_EQ(paper.preprocess.range.max_range_m, 400.0);
  EXPECT_EQ(paper.normals.radius_m, 2.0);
  EXPECT_EQ(paper.normals.max_neighbours, 30);
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

TEST(OdometryConfig, AMountingThatIsNoRigidMotionIsRefused) {
  const auto make = [](const Eigen::Isometry3d& T_vehicle_sensor) {
    return make_odometry(DopplerIcpConfig{}, {T_vehicle_sensor, DopplerKind::kRelative}, 1);
  };
  EXPECT_NO_THROW(make(Eigen::Isometry3d::Identity()));
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e150}) {
    Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
    far.translation().y() = bad;
    EXPECT_THROW(make(far), UsageError) << bad;
    Eigen::Isometry3d sheared = Eigen::Isometry3d::Identity();
    sheared.linear()(0, 1) = bad;
    EXPECT_THROW(make(sheared), UsageError) << bad;
  }
}

std::vector<std::string> texts(Config config) {
  std::vector<std::string> all;
  for (const ConfigField& field : fields(config)) {
    all.push_back(field.key + "=" + value_text(field));
  }
  return all;
}

TEST(OdometryConfig, AnEmptyOneIsPresetDefault) {
  EXPECT_EQ(texts({}), texts(configuration("dynamic-icp")));
  EXPECT_TRUE(std::holds_alternative<WindowOdometryConfig>(Config{}));
  EXPECT_TRUE(std::holds_alternative<PaperConfig>(configuration("dynamic-icp", "paper")));
}

TEST(OdometryConfig, ThePresetIsThatOfDynamicIcpAlone) {
  for (const std::string_view method : method_names()) {
    const bool has_presets = method == "dynamic-icp";
    EXPECT_EQ(texts(configuration(method, "default")) != texts(configuration(method, "paper")), has_presets) << method;
    EXPECT_THROW(configuration(method, "best"), UsageError);
  }
  EXPECT_THROW(configuration("magic"), UsageError);
}

TEST(OdometryConfig, EveryPipelineHasEachKeyOnceAndPassesItsOwnCheck) {
  for (const Pipeline& pipeline : pipelines()) {
    Config config = pipeline.config;
    std::set<std::string> keys;
    for (const ConfigField& field : fields(config)) {
      EXPECT_TRUE(keys.insert(field.key).second) << field.key;
      EXPECT_FALSE(field.description.empty()) << field.key;
      EXPECT_NO_THROW(set_field(fields(config), field.key, value_text(field))) << field.key;
    }
    EXPECT_NO_THROW(check(config)) << pipeline.method << pipeline.preset;
  }
}

// A value out of its range is found in each of the settings of each pipeline.
TEST(OdometryConfig, EveryNumberOutOfRangeIsRefused) {
  for (const Pipeline& pipeline : pipelines()) {
    Config config = pipeline.config;
    for (const ConfigField& field : fields(config)) {
      const Config before = config;
      if (double* const* number = std::get_if<double*>(&field.value)) {
        **number = std::numeric_limits<double>::quiet_NaN();
      } else if (int* const* count = std::get_if<int*>(&field.value)) {
        **count = static_cast<int>(field.minimum) - 1;
      } else {
        continue;
      }
      EXPECT_THROW(check(config), UsageError) << field.key;
      EXPECT_THROW(make_odometry(config, {}, 1), UsageError) << field.key;
      config = before;
    }
  }
}

TEST(OdometryConfig, PipelinesHaveTheKeysOfTheirOwnPartsOnly) {
  const auto has = [](const Config& config, std::string_view part) {
    const std::vector<std::string> all = texts(config);
    return std::ranges::any_of(all, [&](const std::string& text) { return text.starts_with(part); });
  };
  EXPECT_FALSE(has(configuration("point-to-point"), "preprocess.normals."));
  EXPECT_TRUE(has(configuration("gicp"), "preprocess.normals."));
  EXPECT_FALSE(has(configuration("gicp"), "doppler_icp."));
  EXPECT_FALSE(has(PaperConfig{}, "mapping."));
  EXPECT_FALSE(has(WindowOdometryConfig{}, "registration.tolerance"));
  EXPECT_FALSE(has(KissIcpConfig{}, "preprocess."));
  EXPECT_FALSE(has(WindowOdometryConfig{}, "ego_motion.regression."));
}

TEST(OdometryConfig, ValuesThatDoNotGoTogetherAreRefused) {
  PaperConfig paper;
  paper.preprocess.range.min_range_m = 500.0;
  EXPECT_THROW(check(paper), UsageError);
  DopplerIcpConfig doppler_icp;
  doppler_icp.icp.preprocess.range.min_range_m = 500.0;
  EXPECT_THROW(check(doppler_icp), UsageError);
  WindowOdometryConfig config;
  config.preprocess.voxel.voxel_size_m = 1e-5;
  EXPECT_THROW(check(config), UsageError);
  config.preprocess.voxel.voxel_size_m = 0.0;
  EXPECT_NO_THROW(check(config));
  config.ego_motion.consensus.min_noise_mps = 2.0 * config.ego_motion.consensus.max_noise_mps;
  EXPECT_THROW(check(config), UsageError);
}

TEST(OdometryConfig, AblationsSwitchOffWhatThePaperSwitchesOff) {
  PaperConfig paper;
  apply_ablation(paper, "no-vf");
  EXPECT_FALSE(paper.ego_motion.filter.enabled);
  apply_ablation(paper, "no-dpp");
  EXPECT_FALSE(paper.dynamics.predict);
  apply_ablation(paper, "no-dr");
  EXPECT_EQ(paper.registration.doppler_weight, 0.0);
  EXPECT_NO_THROW(apply_ablation(paper, "none"));
  EXPECT_THROW(apply_ablation(paper, "no-such"), UsageError);
  EXPECT_THROW(apply_ablation(paper, "no-map"), UsageError);
  Config baseline = configuration("gicp");
  EXPECT_NO_THROW(apply_ablation(baseline, "none"));
  EXPECT_THROW(apply_ablation(baseline, "no-vf"), UsageError);
}

// Each is one switch or number that is off or zero afterwards.
TEST(OdometryConfig, EachAblationChangesOneSetting) {
  for (const Pipeline& pipeline : pipelines()) {
    for (const std::string_view name : ablation_names(pipeline.config)) {
      Config config = pipeline.config;
      apply_ablation(config, name);
      const std::vector<std::string> before = texts(pipeline.config);
      std::vector<std::string> changed = texts(config);
      std::erase_if(changed, [&](const std::string& text) { return std::ranges::find(before, text) != before.end(); });
      std::erase_if(changed, [](const std::string& text) { return text.starts_with("ego_motion.regression."); });
      ASSERT_EQ(changed.size(), name == "none" ? 0u : 1u) << name;
      EXPECT_TRUE(name == "none" || changed[0].ends_with("=false") || changed[0].ends_with("=0")) << changed[0];
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::odometry
