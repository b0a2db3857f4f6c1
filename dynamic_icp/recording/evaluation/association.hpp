// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/recording/formats/trajectory.hpp"

namespace dynamic_icp::evaluation {

struct AssociationConfig {
  double max_gap_s = 0.2;
};
ConfigFields fields(AssociationConfig& config);

/// Estimate and reference at the same times: `estimate[k]` and `reference[k]` have the same stamp.
struct Association {
  formats::Trajectory estimate;
  formats::Trajectory reference;
  std::vector<std::size_t> estimate_indices;  ///< where estimate[k] stands in the whole estimate; increasing
  std::size_t estimate_count = 0;             ///< poses of the whole estimate, matched or not
  std::size_t reference_count = 0;            ///< poses of the whole reference
  std::size_t exact_count = 0;                ///< matches with the very same stamp; the others are interpolated

  [[nodiscard]] std::size_t size() const { return estimate.size(); }
};

/// Finds the reference pose at the time of each estimated pose:
///   1. the reference pose with the same stamp, to the nanosecond;
///   2. else the interpolation between the reference poses before and after (position linear, rotation along the
///      shortest arc), if these two are at most max_gap_s apart;
///   3. else a reference pose at most a microsecond away: stamps that were kept in a double are rounded by up to 0.24
///      microseconds, and the first and last pose must not be lost by that.
/// Other estimated poses stay unmatched; nothing is extrapolated.
///
/// Throws DataError when not a single pose matches (the message says both time spans and what may be wrong), and when a
/// trajectory is empty, has a pose that is not finite or stamps that do not increase. Throws UsageError for a
/// configuration out of range.
Association associate(const formats::Trajectory& estimate, const formats::Trajectory& reference,
                      const AssociationConfig& config = {});

/// The distance travelled from the first pose to each pose, m: [0, |p1 - p0|, |p1 - p0| + |p2 - p1|, ...].
std::vector<double> path_distances(const formats::Trajectory& trajectory);

}  // namespace dynamic_icp::evaluation
