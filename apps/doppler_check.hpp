// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/datasets/dataset.hpp"

namespace dynamic_icp::apps {

/// What the Doppler of a recording looks like, from a few scans spread over it.
struct DopplerCheck {
  std::size_t scans = 0;
  double mean_speed_mps = 0.0;        ///< of the sensor, by Huber regression scan by scan
  double inlier_share = 0.0;          ///< residuals within 0.5 m/s of a static scene
  double median_residual_mps = 0.0;   ///< of |s + u.v|
  std::optional<double> speed_ratio;  ///< regressed velocity over that of the ground truth, along the latter
  std::string verdict;                ///< in words, with the evidence
};

DopplerCheck check_doppler(const datasets::Dataset& dataset, const Workers& workers);

}  // namespace dynamic_icp::apps
