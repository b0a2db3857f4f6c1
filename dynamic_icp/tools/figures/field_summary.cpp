// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_summary.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::figures {
namespace {

constexpr double kDegreesOfRadian = 180.0 / std::numbers::pi;

// As many as the field has columns over the view of one sensor.
constexpr std::size_t kCellColumns = 48;
constexpr Eigen::Index kCellRows = 8;
// Lines differ: one of them does not stand for all in a cell.
constexpr Eigen::Index kSamplesOfCell = 6;

ErrorSizes sizes_of(const std::vector<double>& errors_mps, const std::vector<double>& sigmas_mps) {
  ErrorSizes sizes;
  double squares = 0.0;
  for (const double error : errors_mps) {
    squares += error * error;
    sizes.largest_mps = std::max(sizes.largest_mps, std::abs(error));
  }
  sizes.rms_mps = errors_mps.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(errors_mps.size()));
  sizes.median_sigma_mps = median(sigmas_mps);
  return sizes;
}

std::vector<double> numbers_of(const Eigen::MatrixXd& values) { return {values.data(), values.data() + values.size()}; }

/// Means over the rows of each cell. The standard deviation of a mean is at most the mean of the standard deviations.
window::ErrorByDirection cells_of(const window::ErrorByDirection& samples) {
  const Eigen::Index columns = samples.error_mps.cols();
  window::ErrorByDirection cells{
      samples.azimuths_rad, {}, Eigen::MatrixXd(kCellRows, columns), Eigen::MatrixXd(kCellRows, columns)};
  for (Eigen::Index row = 0; row < kCellRows; ++row) {
    const Eigen::Index first = row * kSamplesOfCell;
    cells.error_mps.row(row) = samples.error_mps.middleRows(first, kSamplesOfCell).colwise().mean();
    cells.sigma_mps.row(row) = samples.sigma_mps.middleRows(first, kSamplesOfCell).colwise().mean();
    cells.elevations_rad.push_back(0.5 *
                                   (samples.elevations_rad[static_cast<std::size_t>(first)] +
                                    samples.elevations_rad[static_cast<std::size_t>(first + kSamplesOfCell - 1)]));
  }
  return cells;
}

}  // namespace

ShownView shown_view(const window::FieldShape::View& view) {
  return {-kDegreesOfRadian * (view.azimuth_first + view.azimuth_span), -kDegreesOfRadian * view.azimuth_first,
          kDegreesOfRadian * view.elevation_first, kDegreesOfRadian * (view.elevation_first + view.elevation_span)};
}

std::vector<FieldSummary> field_summaries(const window::SensorCalibration& calibration) {
  std::vector<FieldSummary> summaries;
  for (std::size_t sensor = 0; sensor < calibration.shape.views.size(); ++sensor) {
    const window::ErrorByDirection samples =
        window::error_by_direction(calibration, sensor, kCellColumns, kCellRows * kSamplesOfCell);
    FieldSummary summary{shown_view(calibration.shape.views[sensor]),
                         sizes_of(numbers_of(samples.error_mps), numbers_of(samples.sigma_mps)),
                         {},
                         cells_of(samples)};
    // Every sensor has the same parts, and those of one stand beside each other.
    const std::size_t parts = calibration.parts.size() / calibration.shape.views.size();
    for (std::size_t k = sensor * parts; k < (sensor + 1) * parts; ++k) {
      const window::SensorCalibration::Part& part = calibration.parts[k];
      summary.parts.push_back(
          {part.name, part.scale_mps, part.error_mps.size(), sizes_of(part.error_mps, part.sigma_mps)});
    }
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

}  // namespace dynamic_icp::figures
