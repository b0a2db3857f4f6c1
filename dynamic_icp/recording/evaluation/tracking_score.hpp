// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dynamic_icp::evaluation {

/// The bodies of one scan.
struct ScoredScan {
  std::vector<std::int64_t> true_ids;
  std::vector<std::int64_t> reported_ids;
  Eigen::MatrixXd similarity;  ///< true x reported, 0 (nothing in common) to 1 (equal)
};

/// Scores of multi-object tracking. Empty where nothing is there to be tracked or was reported.
struct TrackingScore {
  // HOTA (Luiten et al., IJCV 2021), each the mean over the thresholds 0.05, 0.1, ... 0.95 of the similarity
  std::optional<double> hota;
  std::optional<double> detection;     ///< DetA: found and not invented
  std::optional<double> association;   ///< AssA: the same id for the same body
  std::optional<double> localisation;  ///< LocA: similarity of pairs
  // CLEAR MOT (Bernardin and Stiefelhagen 2008) and IDF1 (Ristani et al. 2016) at one threshold
  std::optional<double> mota;  ///< 1 - (misses + false ones + id switches) / true ones
  std::optional<double> idf1;
  std::size_t true_bodies = 0;  ///< over all scans
  std::size_t found = 0;
  std::size_t false_bodies = 0;
  std::size_t id_switches = 0;
};

/// Scans in their order; ids are unique within a scan. `threshold`: the smallest similarity of a pair for MOTA and
/// IDF1.
TrackingScore score_tracking(const std::vector<ScoredScan>& scans, double threshold);

}  // namespace dynamic_icp::evaluation
