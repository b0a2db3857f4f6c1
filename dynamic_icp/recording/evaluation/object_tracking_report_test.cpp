// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/object_tracking_report.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace dynamic_icp::evaluation {
namespace {

TEST(ObjectTrackingReport, WhatIsNotKnownIsNullInJsonAndADashInTheTable) {
  const auto report = nlohmann::json::parse(tracking_json({}));
  for (const char* key : {"nees_center", "predicted_center_mae_m", "nees_predicted_center", "points_in_box_median",
                          "points_in_box_p5", "map_ghosts", "id_switches_per_100_s"}) {
    EXPECT_TRUE(report.at(key).is_null()) << key;
  }
  EXPECT_EQ(report.at("predictions"), 0);
  EXPECT_NE(tracking_table({}).find("static points on moving bodies                         - %\n"), std::string::npos)
      << tracking_table({});
}

TEST(ObjectTrackingReport, SharesArePercentInTheTableAlone) {
  ObjectTracking tracking;
  tracking.prediction = {7, 0.5, 3.25};
  tracking.held = {0.875, 0.75};
  tracking.map_ghosts = 0.00125;
  const auto report = nlohmann::json::parse(tracking_json(tracking));
  EXPECT_EQ(report.at("predictions"), 7);
  EXPECT_EQ(report.at("predicted_center_mae_m"), 0.5);
  EXPECT_EQ(report.at("nees_predicted_center"), 3.25);
  EXPECT_EQ(report.at("points_in_box_median"), 0.875);
  EXPECT_EQ(report.at("points_in_box_p5"), 0.75);
  EXPECT_EQ(report.at("map_ghosts"), 0.00125);
  const std::string table = tracking_table(tracking);
  for (const char* line : {"5th percentile       75.000 %\n", "moving bodies                     0.125 %\n"}) {
    EXPECT_NE(table.find(line), std::string::npos) << table;
  }
}

}  // namespace
}  // namespace dynamic_icp::evaluation
