// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/method/window/error_by_direction.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::figures {

/// Pictures of an error do not blow up what is smaller, m/s.
inline constexpr double kMinError_mps = 1e-3;

/// The directions that a sensor measures in, as it looks out: azimuth to the right.
struct ShownView {
  double left_deg = 0.0;
  double right_deg = 0.0;
  double bottom_deg = 0.0;
  double top_deg = 0.0;
};

ShownView shown_view(const window::FieldShape::View& view);

/// How large numbers are that were learned, m/s.
struct ErrorSizes {
  double rms_mps = 0.0;
  double largest_mps = 0.0;       ///< without sign
  double median_sigma_mps = 0.0;  ///< of their standard deviations
};

/// One part of the error, such as that of the mirror faces.
struct PartSummary {
  std::string name;
  double scale_mps = 0.0;  ///< standard deviation that such errors of this sensor have
  std::size_t unknowns = 0;
  ErrorSizes sizes;
};

/// What was learned of one sensor's Doppler in numbers.
struct FieldSummary {
  ShownView view;
  ErrorSizes sizes;  ///< over the view
  std::vector<PartSummary> parts;
  window::ErrorByDirection cells;  ///< means over equal parts of the view
};

/// Of each sensor. Throws UsageError when the parts of the calibration do not fit each other.
std::vector<FieldSummary> field_summaries(const window::SensorCalibration& calibration);

}  // namespace dynamic_icp::figures
