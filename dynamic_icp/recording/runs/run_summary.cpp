// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_summary.hpp"

#include <nlohmann/json.hpp>

namespace dynamic_icp::runs {
namespace {

nlohmann::ordered_json number(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace

std::string summary_json(const RunSummary& summary) {
  nlohmann::ordered_json statuses = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < odometry::kVerdicts.size(); ++i) {
    statuses[std::string(odometry::kVerdicts.at(i))] = summary.verdicts.at(i);
  }
  nlohmann::ordered_json reasons = nlohmann::ordered_json::object();
  for (const auto& [reason, count] : summary.reasons) {
    reasons[std::string(to_string(reason))] = count;
  }
  const evaluation::RunAccuracy& accuracy = summary.accuracy;
  const nlohmann::ordered_json json = {
      {"method", summary.method},
      {"frames", summary.frames},
      {"rte_rmse_m", number(accuracy.rte_rmse_m)},
      {"rte_mean_m", number(accuracy.rte_mean_m)},
      {"rte_median_m", number(accuracy.rte_median_m)},
      {"rre_rmse_deg", number(accuracy.rre_rmse_deg)},
      {"rre_mean_deg", number(accuracy.rre_mean_deg)},
      {"rre_median_deg", number(accuracy.rre_median_deg)},
      {"ate_rmse_m", number(accuracy.ate_rmse_m)},
      {"path_length_m", number(accuracy.path_length_m)},
      {"nees_rotation", number(accuracy.consistency.nees_rotation)},
      {"nees_translation", number(accuracy.consistency.nees_translation)},
      {"beyond_4_sigma", number(accuracy.consistency.beyond_4_sigma)},
      {"mean_iterations", number(summary.mean_iterations)},
      {"convergence_rate", number(summary.convergence_rate)},
      {"ms_mean", number(summary.ms_mean)},
      {"ms_median", number(summary.ms_median)},
      {"ms_p95", number(summary.ms_p95)},
      {"fps", number(summary.fps)},
      {"dynamic_ratio_mean", number(summary.dynamic_ratio_mean)},
      {"dynamic_ratio_max", number(summary.dynamic_ratio_max)},
      {"clustered_ratio_mean", number(summary.clustered_ratio_mean)},
      {"refined_ratio_mean", number(summary.refined_ratio_mean)},
      {"matched_poses", accuracy.matched},
      {"statuses", statuses},
      {"reasons", reasons},
      {"failure", summary.failure.empty() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(summary.failure)},
      {"stopped", summary.stopped},
      {"assumptions", summary.assumptions}};
  return json.dump(2);
}

}  // namespace dynamic_icp::runs
