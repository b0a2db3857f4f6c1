// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/summary_keys.hpp"

#include <gtest/gtest.h>

namespace dynamic_icp::report {
namespace {

TEST(SummaryKeys, HaveUnits) {
  const runs::Settings summary = {
      {"rte_rmse_m", 0.012345},     {"rre_rmse_deg", 0.5}, {"ms_p95", 1234.5}, {"fps", 12.0},
      {"convergence_rate", 0.9876}, {"frames", 123456.0},  {"method", "gicp"}, {"ate_rmse_m", {}}};
  EXPECT_EQ(value_with_unit(summary, "rte_rmse_m"), "12.35 mm");
  EXPECT_EQ(value_with_unit(summary, "rre_rmse_deg"), "0.5°");
  EXPECT_EQ(value_with_unit(summary, "fps"), "12 1/s");
  EXPECT_EQ(value_with_unit(summary, "convergence_rate"), "98.76 %");
  EXPECT_EQ(value_with_unit(summary, "frames"), "123456");
  EXPECT_EQ(value_with_unit(summary, "method"), "gicp");
  EXPECT_EQ(value_with_unit(summary, "ate_rmse_m"), "-");
  EXPECT_EQ(value_with_unit(summary, "absent"), "-");
  EXPECT_EQ(value_with_unit(summary, "ms_p95"), "1234 ms");
}

TEST(SummaryKeys, ErrorsAreInMillimetresWhereTheyAreSmall) {
  const runs::Settings summary = {{"rte_mean_m", 0.000787}, {"rte_median_m", 2.9012}, {"ate_rmse_m", 0.0312},
                                  {"ate_rmse_far_m", 17.5}, {"path_length_m", 0.5},   {"beyond_4_sigma", 0.01}};
  EXPECT_EQ(value_with_unit(summary, "rte_mean_m"), "0.787 mm");
  EXPECT_EQ(value_with_unit(summary, "rte_median_m"), "2901 mm");
  EXPECT_EQ(value_with_unit(summary, "ate_rmse_m"), "31.2 mm");
  EXPECT_EQ(value_with_unit(summary, "ate_rmse_far_m"), "17.5 m");
  EXPECT_EQ(value_with_unit(summary, "path_length_m"), "0.5 m") << "no error";
  EXPECT_EQ(value_with_unit(summary, "beyond_4_sigma"), "1 %");
}

TEST(SummaryKeys, StatusesAreNamed) {
  EXPECT_EQ(meaning_of("statuses.time_gap"), "scans: time gap");
  EXPECT_EQ(meaning_of("statuses.first"), "scans: first");
  EXPECT_EQ(meaning_of("something new"), "");
}

}  // namespace
}  // namespace dynamic_icp::report
