// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/config.hpp"

#include <limits>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"

#include "testing/synthetic_drive.hpp"

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

TEST(OdometryConfig, AMountingThatIsNoRigidMotionIsRefused) {
  const auto make = [](const Eigen::Isometry3d& T_vehicle_sensor) {
    return make_odometry("doppler-icp", {}, {T_vehicle_sensor, DopplerKind::kRelative}, 1);
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

TEST(OdometryConfig, AnEmptyOneIsPresetDefault) {
  Config empty;
  Config named = preset("default");
  const ConfigFields expected = fields(named);
  const ConfigFields found = fields(empty);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(value_text(found[i]), value_text(expected[i])) << found[i].key;
  }
  EXPECT_FALSE(empty.scan_to_scan);
}

TEST(OdometryConfig, EveryKeyHasAnEffectOnSomeMethod) {
  std::set<std::string> effective;
  for (const char* name : {"default", "paper"}) {
    for (const std::string_view method : method_names()) {
      Config config = preset(name);
      for (const ConfigField& field : effective_fields(config, method)) {
        effective.insert(field.key);
      }
    }
  }
  Config config;
  config.ego_motion.use_consensus = false;
  for (const ConfigField& field : effective_fields(config, "dynamic-icp")) {
    effective.insert(field.key);
  }
  for (const ConfigField& field : fields(config)) {
    EXPECT_TRUE(effective.contains(field.key)) << field.key;
  }
}

/// Another value that is allowed: the other one of two, or an end of the range.
void change(const ConfigFields& fields, const ConfigField& field) {
  if (bool* const* flag = std::get_if<bool*>(&field.value)) {
    **flag = !**flag;
    return;
  }
  const std::string before = value_text(field);
  set_field(fields, field.key, fmt::format("{}", field.maximum));
  if (value_text(field) == before) {
    set_field(fields, field.key, fmt::format("{}", field.minimum));
  }
}

// Each method with all keys changed that it is said not to read.
TEST(OdometryConfig, KeysWithoutEffectHaveNone) {
  const synthetic::Drive drive{synthetic::street(), synthetic::circle(10.0, 0.2), {}};
  for (const char* name : {"default", "paper"}) {
    for (const std::string_view method : method_names()) {
      Config plain = preset(name);
      Config changed = plain;
      std::set<std::string> effective = {"odometry.scan_to_scan"};
      for (const ConfigField& field : effective_fields(plain, method)) {
        effective.insert(field.key);
      }
      const ConfigFields all = fields(changed);
      for (const ConfigField& field : all) {
        if (!effective.contains(field.key) && field.key != "ego_motion.consensus.min_noise_mps") {
          change(all, field);
        }
      }
      const auto expected = make_odometry(method, plain, {}, 1);
      const auto found = make_odometry(method, changed, {}, 1);
      for (int k = 0; k < 4; ++k) {
        const RawScan scan = drive.scan(k);
        EXPECT_EQ(found->process(scan).T_world_sensor.matrix(), expected->process(scan).T_world_sensor.matrix())
            << method << " " << name << " scan " << k;
      }
    }
  }
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
  Config config = preset("paper");
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
