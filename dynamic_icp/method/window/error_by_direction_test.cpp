// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/error_by_direction.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/window/doppler_error_field.hpp"

#include "testing/dense_algebra.hpp"
#include "testing/sensor_calibration.hpp"

namespace dynamic_icp::window {
namespace {

using Eigen::Index;

FieldShape front_view() {
  FieldShape shape;
  shape.views = {{-1.0, 2.0, -0.2, 0.3}};
  shape.line_elevations_rad = {0.1, -0.05, 0.02, -0.15};  // in no order
  shape.faces = 3;
  return shape;
}

TEST(ErrorByDirection, IsThatOfTheFieldWithTheNearestLine) {
  const FieldShape shape = front_view();
  DopplerErrorField field(shape);
  std::mt19937 random(1);
  const auto n = static_cast<Index>(field.size());
  const Eigen::VectorXd theta = 0.1 * dense::random_matrix(random, n, 1);
  const Eigen::MatrixXd information = 400.0 * dense::random_information(random, n);
  const ErrorByDirection errors = error_by_direction(calibration_of(shape, theta, information), 0, 5, 3);
  ASSERT_EQ(errors.azimuths_rad.size(), 5U);
  ASSERT_EQ(errors.elevations_rad.size(), 3U);
  EXPECT_NEAR(errors.azimuths_rad[2], 0.0, 1e-12);
  EXPECT_NEAR(errors.elevations_rad[0], -0.15, 1e-12);

  for (DopplerErrorField::Group& group : field.groups()) {
    group.tau = 0.1;
  }
  Eigen::MatrixXd all = information;
  field.add_prior_information(all);
  const Eigen::MatrixXd covariance = dense::inverse(all);
  constexpr std::array<std::uint16_t, 3> nearest_line = {3, 1, 2};  // -0.15, -0.05 and 0.05 rad
  for (const auto& [row, column] : {std::pair<Index, Index>(0, 0), {1, 3}, {2, 4}}) {
    DopplerCell cell;
    const double azimuth = errors.azimuths_rad[static_cast<std::size_t>(column)];
    const double elevation = errors.elevations_rad[static_cast<std::size_t>(row)];
    cell.u << std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation);
    cell.range_m = 30.0;
    cell.line = nearest_line[static_cast<std::size_t>(row)];
    // By differences: the field is linear in theta.
    Eigen::VectorXd by_unknowns(n);
    double mean = 0.0;
    for (Index k = -1; k < n; ++k) {
      const Eigen::VectorXd at = k < 0 ? theta : Eigen::VectorXd(Eigen::VectorXd::Unit(n, k));
      double sum = 0.0;
      for (cell.face = 0; cell.face < 3; ++cell.face) {
        sum += field.at(cell, at) / 3.0;
      }
      (k < 0 ? mean : by_unknowns[k]) = sum;
    }
    EXPECT_NEAR(errors.error_mps(row, column), mean, 1e-12);
    EXPECT_NEAR(errors.sigma_mps(row, column), std::sqrt(by_unknowns.dot(covariance * by_unknowns)), 1e-9);
  }
}

TEST(ErrorByRange, IsThatOfTheFieldWithoutWhatIsTheSameAtAllRanges) {
  const FieldShape shape = front_view();
  DopplerErrorField field(shape);
  std::mt19937 random(2);
  const auto n = static_cast<Index>(field.size());
  const Eigen::VectorXd theta = 0.1 * dense::random_matrix(random, n, 1);
  const Eigen::MatrixXd information = 400.0 * dense::random_information(random, n);
  constexpr std::array<double, 3> ranges_m = {5.0, 30.0, 120.0};
  const ErrorByRange errors = error_by_range(calibration_of(shape, theta, information), 0, ranges_m);

  for (DopplerErrorField::Group& group : field.groups()) {
    group.tau = 0.1;
  }
  Eigen::MatrixXd all = information;
  field.add_prior_information(all);
  const Eigen::MatrixXd covariance = dense::inverse(all);
  DopplerCell cell;
  cell.u = {0.0, 0.6, 0.8};  // another direction than that of the code: all are alike
  cell.line = 2;
  for (std::size_t k = 0; k < ranges_m.size(); ++k) {
    const auto difference = [&](const Eigen::VectorXd& at) {
      cell.range_m = ranges_m[k];
      const double there = field.at(cell, at);
      cell.range_m = 30.0;
      return there - field.at(cell, at);
    };
    Eigen::VectorXd by_unknowns(n);
    for (Index i = 0; i < n; ++i) {
      by_unknowns[i] = difference(Eigen::VectorXd::Unit(n, i));
    }
    EXPECT_NEAR(errors.error_mps[k], difference(theta), 1e-12);
    EXPECT_NEAR(errors.sigma_mps[k], std::sqrt(by_unknowns.dot(covariance * by_unknowns)), 1e-9);
  }
  EXPECT_EQ(errors.sigma_mps[1], 0.0) << "at 30 m it is compared with itself";
}

TEST(ErrorByDirection, NeedsAFieldThatFits) {
  const FieldShape shape = front_view();
  const DopplerErrorField field(shape);
  const auto n = static_cast<Index>(field.size());
  SensorCalibration calibration = calibration_of(shape, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Identity(n, n));
  EXPECT_THROW(error_by_direction(calibration, 1, 5, 3), UsageError);
  EXPECT_THROW(error_by_range(calibration, 1, {}), UsageError);
  calibration.parts.pop_back();
  EXPECT_THROW(error_by_direction(calibration, 0, 5, 3), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::window
