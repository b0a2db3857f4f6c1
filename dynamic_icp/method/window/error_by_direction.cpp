// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/error_by_direction.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/window/learned_field.hpp"

namespace dynamic_icp::window {
namespace {

constexpr double kMediumRange_m = 30.0;

std::vector<double> middles(double first, double span, std::size_t count) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back(first + span * (static_cast<double>(k) + 0.5) / static_cast<double>(count));
  }
  return values;
}

/// The line that measures nearest to an elevation; 0 without lines.
std::size_t nearest_line(const FieldShape& shape, double elevation_rad) {
  const std::vector<double>& lines = shape.line_elevations_rad;
  const auto nearest = std::ranges::min_element(lines, {}, [&](double line) { return std::abs(line - elevation_rad); });
  return nearest == lines.end() ? 0 : static_cast<std::size_t>(nearest - lines.begin());
}

void check_sensor(const SensorCalibration& calibration, std::size_t sensor) {
  if (sensor >= calibration.shape.views.size()) {
    throw UsageError(fmt::format("sensor {} of a calibration of {}", sensor, calibration.shape.views.size()));
  }
}

/// The root of the information of theta with its prior.
Eigen::LLT<Eigen::MatrixXd> information_root(const LearnedField& learned) {
  Eigen::MatrixXd information = learned.information;
  learned.field.add_prior_information(information);
  return Eigen::LLT<Eigen::MatrixXd>(information);
}

/// How the error in a direction depends on the unknowns of the field, with the mean of the faces.
Eigen::VectorXd mean_columns(const DopplerErrorField& field, DopplerCell cell) {
  const std::size_t faces = field.shape().faces;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(field.size()));
  for (std::size_t face = 0; face < faces; ++face) {
    cell.face = static_cast<decltype(cell.face)>(face);
    const FieldColumns columns = field.columns(cell);
    for (std::size_t k = 0; k < columns.size; ++k) {
      mean[columns.index[k]] += columns.value[k] / static_cast<double>(faces);
    }
  }
  return mean;
}

}  // namespace

ErrorByDirection error_by_direction(const SensorCalibration& calibration, std::size_t sensor, std::size_t azimuths,
                                    std::size_t elevations) {
  check_sensor(calibration, sensor);
  const LearnedField learned = learned_field(calibration);
  const Eigen::LLT<Eigen::MatrixXd> root = information_root(learned);
  const FieldShape::View& view = calibration.shape.views[sensor];
  ErrorByDirection result{middles(view.azimuth_first, view.azimuth_span, azimuths),
                          middles(view.elevation_first, view.elevation_span, elevations),
                          {},
                          {}};
  result.error_mps.resize(static_cast<Eigen::Index>(elevations), static_cast<Eigen::Index>(azimuths));
  result.sigma_mps = result.error_mps;
  DopplerCell cell;
  cell.sensor = static_cast<decltype(cell.sensor)>(sensor);
  cell.range_m = kMediumRange_m;
  cell.intensity = calibration.shape.intensity_mean;
  for (Eigen::Index row = 0; row < result.error_mps.rows(); ++row) {
    const double elevation = result.elevations_rad[static_cast<std::size_t>(row)];
    cell.line = static_cast<decltype(cell.line)>(nearest_line(calibration.shape, elevation));
    for (Eigen::Index column = 0; column < result.error_mps.cols(); ++column) {
      const double azimuth = result.azimuths_rad[static_cast<std::size_t>(column)];
      cell.u << std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation);
      const Eigen::VectorXd by_unknowns = mean_columns(learned.field, cell);
      result.error_mps(row, column) = by_unknowns.dot(learned.theta);
      result.sigma_mps(row, column) = root.matrixL().solve(by_unknowns).norm();
    }
  }
  return result;
}

ErrorByRange error_by_range(const SensorCalibration& calibration, std::size_t sensor,
                            std::span<const double> ranges_m) {
  check_sensor(calibration, sensor);
  const LearnedField learned = learned_field(calibration);
  const Eigen::LLT<Eigen::MatrixXd> root = information_root(learned);
  DopplerCell cell;
  cell.sensor = static_cast<decltype(cell.sensor)>(sensor);
  cell.intensity = calibration.shape.intensity_mean;
  const auto columns_at = [&](double range_m) {
    cell.range_m = range_m;
    return mean_columns(learned.field, cell);
  };
  cell.u = Eigen::Vector3d::UnitX();  // whichever: it cancels
  const Eigen::VectorXd medium = columns_at(kMediumRange_m);
  ErrorByRange result;
  for (const double range_m : ranges_m) {
    const Eigen::VectorXd by_unknowns = columns_at(range_m) - medium;
    result.error_mps.push_back(by_unknowns.dot(learned.theta));
    result.sigma_mps.push_back(root.matrixL().solve(by_unknowns).norm());
  }
  return result;
}

}  // namespace dynamic_icp::window
