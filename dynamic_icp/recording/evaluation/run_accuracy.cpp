// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/run_accuracy.hpp"

#include "dynamic_icp/recording/evaluation/evaluation.hpp"

namespace dynamic_icp::evaluation {

RunAccuracy evaluate_run(const formats::Trajectory& estimate, const formats::Trajectory& reference,
                         std::span<const StatedMotion> stated) {
  RunAccuracy accuracy;
  if (estimate.empty() || reference.empty()) {
    return accuracy;
  }
  const Evaluation evaluation = evaluate(estimate, reference, {}, stated);
  accuracy.matched = evaluation.matched.size();
  accuracy.path_length_m = evaluation.reference_path_length_m;
  accuracy.consistency = evaluation.consistency;
  if (const std::optional<Statistics>& rte = evaluation.relative.translation_m) {
    accuracy.rte_rmse_m = rte->rmse;
    accuracy.rte_mean_m = rte->mean;
    accuracy.rte_median_m = rte->median;
  }
  if (const std::optional<Statistics>& rre = evaluation.relative.rotation_deg) {
    accuracy.rre_rmse_deg = rre->rmse;
    accuracy.rre_mean_deg = rre->mean;
    accuracy.rre_median_deg = rre->median;
  }
  if (const std::optional<Statistics>& ate = evaluation.absolute.translation_m) {
    accuracy.ate_rmse_m = ate->rmse;
  }
  return accuracy;
}

}  // namespace dynamic_icp::evaluation
