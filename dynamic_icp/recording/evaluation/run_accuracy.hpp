// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "dynamic_icp/recording/evaluation/consistency.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::evaluation {

/// The accuracy of a run in a few numbers, as `summary.json` holds them. A number that cannot be told (a single pose
/// has no relative error) is empty, never NaN.
struct RunAccuracy {
  std::size_t matched = 0;  ///< estimated poses with a reference pose; the numbers below are over these
  std::optional<double> rte_rmse_m;
  std::optional<double> rte_mean_m;
  std::optional<double> rte_median_m;
  std::optional<double> rre_rmse_deg;
  std::optional<double> rre_mean_deg;
  std::optional<double> rre_median_deg;
  std::optional<double> ate_rmse_m;     ///< after the best rigid alignment
  std::optional<double> path_length_m;  ///< of the reference, over the matched poses
  Consistency consistency;              ///< of the covariances that the run states
};

/// Frame-to-frame relative errors, the absolute error and the consistency of a run, poses matched with the defaults of
/// `associate`; `stated` as in `evaluate`. An empty estimate or reference gives empty numbers. Throws DataError when
/// both have poses but no stamp matches, and when a pose is not finite or stamps do not increase.
RunAccuracy evaluate_run(const formats::Trajectory& estimate, const formats::Trajectory& reference,
                         std::span<const StatedMotion> stated = {});

}  // namespace dynamic_icp::evaluation
