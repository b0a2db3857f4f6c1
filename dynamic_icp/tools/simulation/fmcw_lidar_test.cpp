// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/fmcw_lidar.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::simulation {
namespace {

TEST(FmcwLidar, DefaultsAreValid) { EXPECT_NO_THROW(check(FmcwLidarConfig{})); }

TEST(FmcwLidar, ImpossibleValuesAreRefused) {
  FmcwLidarConfig config;
  EXPECT_THROW(set_field(fields(config), "rows", "0"), UsageError);
  EXPECT_THROW(set_field(fields(config), "range_noise_m", "-0.1"), UsageError);
  EXPECT_THROW(set_field(fields(config), "dropout_rate", "1.5"), UsageError);
  EXPECT_THROW(set_field(fields(config), "horizontal_fov_deg", "nan"), UsageError);
}

TEST(FmcwLidar, ContradictionsAreRefused) {
  FmcwLidarConfig config;
  config.min_range_m = config.max_range_m = 50.0;
  EXPECT_THROW(check(config), UsageError);
  config = {};
  config.sweep_s = 0.11;
  EXPECT_THROW(check(config), UsageError);
  config.rate_hz = 5.0;
  EXPECT_NO_THROW(check(config));
  config.timing.start_s = 0.2;
  EXPECT_THROW(check(config), UsageError);
  config = {};
  config.row_by_row = true;
  config.beams = 3;
  EXPECT_THROW(check(config), UsageError) << "64 rows";
  config = {};
  config.doppler_error.weak_noise_mps = 0.1;
  EXPECT_THROW(check(config), UsageError) << "no range of detection";
}

TEST(FmcwLidar, WithoutNoiseIsThePerfectSensorWithTheSameView) {
  FmcwLidarConfig config;
  // Every setting away from its default, within its range.
  for (const ConfigField& field : fields(config)) {
    if (auto* const* number = std::get_if<double*>(&field.value)) {
      **number = **number == field.minimum ? 0.5 * field.maximum : 0.5 * (**number + field.minimum);
    }
  }
  FmcwLidarConfig clean = without_noise(config);
  FmcwLidarConfig perfect;
  const ConfigFields before = fields(config);
  const ConfigFields after = fields(clean);
  const ConfigFields defaults = fields(perfect);
  for (std::size_t i = 0; i < after.size(); ++i) {
    // What is left alone: the view, the limits of range, and what only says how an effect behaves that is off now.
    const std::string& key = after[i].key;
    const bool view = key.find("fov") != std::string::npos || key.starts_with("vertical") || key == "columns" ||
                      key == "rows" || key == "rate_hz" || key == "sweep_s" || key == "row_by_row" || key == "unit" ||
                      key == "beams" || key == "faces" || key == "face_per_scan" || key == "timing.start_s" ||
                      key == "scatter_deg" || key == "min_range_m" || key == "max_range_m" ||
                      key.starts_with("weak_when") || key == "range_resolution_m" || key == "rain_range_m" ||
                      key == "doppler_outlier_span_mps";
    EXPECT_EQ(value_text(after[i]), value_text(view ? before[i] : defaults[i])) << key;
  }
}

TEST(FmcwLidar, InstantScansTakeNoTime) {
  FmcwLidarConfig config;
  config.sweep_s = 0.1;
  EXPECT_EQ(instant(config).sweep_s, 0.0);
}

}  // namespace
}  // namespace dynamic_icp::simulation
