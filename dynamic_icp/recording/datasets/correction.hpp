// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::datasets {

/// How the numbers of a recording are to be mended where it, or its layout, says them wrong: what the diagnosis
/// proposes and the options --doppler-sign, --doppler-kind, --doppler-scale, --point-scale, --time-scale and --columns
/// ask for.
struct Correction {
  std::optional<DopplerKind> doppler_kind;    ///< instead of what the layout says
  bool doppler_is_towards = false;            ///< positive towards the sensor: turned round
  double doppler_scale = 1.0;                 ///< of the Doppler: 0.001 for mm/s
  double point_scale = 1.0;                   ///< of x, y, z: 0.001 for mm
  double time_scale = 1.0;                    ///< of the time since the first scan, and of the times of points
  std::array<int, 4> columns = {0, 1, 2, 3};  ///< which of the columns as read are x, y, z and Doppler

  bool operator==(const Correction&) const = default;
};

/// Throws UsageError for scales that are not positive and finite, and for columns that are no permutation of 0..3.
void check(const Correction& correction);

/// One scan mended: points, lines of sight, Doppler, times of points and the kind; not its stamp. Lines of sight that
/// were read are dropped where the Doppler changes places with a coordinate: they were made of the wrong columns.
RawScan corrected(RawScan scan, const Correction& correction);

/// The recording with its numbers mended on the way out. Ground truth is left as it is, but where all its stamps are
/// those of scans they came from the same clock and move with them. Throws UsageError as `check` does, and DataError
/// that names the scan where the scaled time is beyond what a stamp holds.
std::unique_ptr<Dataset> corrected(std::unique_ptr<Dataset> dataset, const Correction& correction);

}  // namespace dynamic_icp::datasets
