// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/window/learned_variance.hpp"
#include "dynamic_icp/method/window/plane_terms.hpp"

namespace dynamic_icp::window {

/// Where the lines of a sensor point: each is off by a constant azimuth and elevation d ~ N(0, tau^2), learned from
/// what is left of the distances of its points from planes, e + J d_known = J d + noise with J = n . dx/d(azimuth,
/// elevation). Scans that do not tell lines are divided into steps of elevation. Planes are those of all lines: what
/// these have in common is a rotation of the sensor and cannot be seen.
class LinePointing {
 public:
  LinePointing();

  /// Takes the errors that are known out of the points of a scan.
  void correct(Scan& points);

  /// Learns from the points that were corrected last; nothing before any were. `planes` are their terms, at the
  /// solution of the scan.
  void learn(const PlaneTerms& planes);

  /// rad, [azimuth; elevation] of the line that the row of the scan corrected last belongs to: measured minus true.
  [[nodiscard]] const Eigen::Vector2d& error(std::size_t row) const { return lines_[line_of_row_[row]].error; }

  /// rad, the standard deviation tau of the errors.
  [[nodiscard]] double sigma_rad() const;

 private:
  struct Line {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();  ///< 1/rad^2, without the prior
    Eigen::Vector2d weighted = Eigen::Vector2d::Zero();     ///< information * what the planes alone say
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
  };

  std::map<std::uint32_t, std::size_t> numbers_;  ///< in `lines_`, by sensor and line
  std::vector<Line> lines_;
  std::vector<std::size_t> line_of_row_;  ///< of the scan that was corrected last
  LearnedVariance variance_;              ///< tau^2
};

}  // namespace dynamic_icp::window
