// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/likely_doppler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Cholesky>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::size_t kRows = 2000;
constexpr std::size_t kMinRows = 10;
constexpr int kRounds = 15;
constexpr double kExplained = 1.0 / 3.0;  // of the spread may be left
constexpr double kMinSpread = 0.05;
constexpr double kAngleTolerance = 0.02;  // rad

/// Median distance from the median.
double spread_of(const std::vector<double>& values) {
  const double middle = median(values);
  std::vector<double> distances(values.size());
  std::transform(values.begin(), values.end(), distances.begin(), [&](double v) { return std::abs(v - middle); });
  return median(std::move(distances));
}

/// Whether most numbers are an angle of their points, in radians or degrees.
bool is_angle(const std::vector<Eigen::Vector3d>& directions, const std::vector<double>& values) {
  const auto is_angle_of = [&](const auto& angle_of, double unit) {
    const auto near = std::count_if(directions.begin(), directions.end(), [&](const Eigen::Vector3d& direction) {
      const double angle = angle_of(direction);
      const double value = unit * values[static_cast<std::size_t>(&direction - directions.data())];
      return std::hypot(std::sin(value) - std::sin(angle), std::cos(value) - std::cos(angle)) < kAngleTolerance;
    });
    return 2 * static_cast<std::size_t>(near) > directions.size();
  };
  const auto azimuth = [](const Eigen::Vector3d& u) { return std::atan2(u.y(), u.x()); };
  const auto elevation = [](const Eigen::Vector3d& u) { return std::asin(std::clamp(u.z(), -1.0, 1.0)); };
  constexpr double kDegree = std::numbers::pi / 180.0;
  return is_angle_of(azimuth, 1.0) || is_angle_of(azimuth, kDegree) || is_angle_of(elevation, 1.0) ||
         is_angle_of(elevation, kDegree);
}

/// The velocity that explains most of the values, and how far it is from each: least squares whose weights fall with
/// the residuals, as moving objects are few.
Eigen::Vector3d robust_velocity(const std::vector<Eigen::Vector3d>& directions, const std::vector<double>& values,
                                double spread, std::vector<double>& residuals) {
  residuals.assign(values.size(), 0.0);
  Eigen::Vector3d v = Eigen::Vector3d::Zero();
  double scale = 10.0 * spread;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Identity() * 1e-9;
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double weight = 1.0 / (1.0 + std::pow(residuals[i] / scale, 2));
      A += weight * directions[i] * directions[i].transpose();
      b += weight * values[i] * directions[i];
    }
    v = A.ldlt().solve(b);
    for (std::size_t i = 0; i < values.size(); ++i) {
      residuals[i] = std::abs(values[i] - v.dot(directions[i]));
    }
    scale = std::max({median(residuals), 1e-3 * spread, 1e-9});
  }
  return v;
}

/// The share of the spread of the values that no velocity explains.
double unexplained(const std::vector<Eigen::Vector3d>& directions, const std::vector<double>& values) {
  const double spread = spread_of(values);
  const bool are_whole = std::all_of(values.begin(), values.end(), [](double v) { return v == std::floor(v); });
  if (values.size() < kMinRows || are_whole || spread < kMinSpread || is_angle(directions, values)) {
    return 1.0;
  }
  std::vector<double> residuals;
  robust_velocity(directions, values, spread, residuals);
  return median(residuals) / spread;
}

/// Directions and values of some of the rows, those without a direction left out.
struct Rows {
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> values;
};

Rows some_rows(std::span<const Eigen::Vector3d> points, const std::vector<double>& column) {
  Rows rows;
  for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / kRows) {
    const double range = points[i].norm();
    if (range > 0.0 && std::isfinite(range) && std::isfinite(column[i])) {
      rows.directions.emplace_back(points[i] / range);
      rows.values.push_back(column[i]);
    }
  }
  return rows;
}

}  // namespace

std::optional<std::size_t> likely_doppler(std::span<const Eigen::Vector3d> points,
                                          std::span<const std::vector<double>> columns) {
  std::optional<std::size_t> best;
  double least = kExplained;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Rows rows = some_rows(points, columns[k]);
    const double left = rows.values.empty() ? 1.0 : unexplained(rows.directions, rows.values);
    if (left < least) {
      least = left;
      best = k;
    }
  }
  return best;
}

std::optional<Eigen::Vector3d> likely_velocity(std::span<const Eigen::Vector3d> points,
                                               const std::vector<double>& doppler) {
  const Rows rows = some_rows(points, doppler);
  if (rows.values.size() < kMinRows) {
    return std::nullopt;
  }
  std::vector<double> residuals;
  return robust_velocity(rows.directions, rows.values, std::max(spread_of(rows.values), kMinSpread), residuals);
}

std::optional<LikelyRow> likely_row(std::span<const std::vector<double>> columns) {
  constexpr std::size_t kPlaces = 2;
  for (std::size_t x = 0; x < kPlaces && x + 3 < columns.size(); ++x) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < columns[x].size(); ++i) {
      points.emplace_back(columns[x][i], columns[x + 1][i], columns[x + 2][i]);
    }
    const std::span<const std::vector<double>> others = columns.subspan(x + 3);
    if (const std::optional<std::size_t> doppler = likely_doppler(points, others)) {
      return LikelyRow{x, x + 3 + *doppler};
    }
  }
  return std::nullopt;
}

std::string proposed_columns(std::span<const std::vector<double>> columns) {
  const LikelyRow row = likely_row(columns).value_or(LikelyRow{0, std::max<std::size_t>(3, columns.size() - 1)});
  std::string text;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const bool is_axis = k >= row.x && k < row.x + 3;
    text += k > 0 ? "," : "";
    text += is_axis ? std::string(1, "xyz"[k - row.x]) : k == row.doppler ? "doppler" : "_";
  }
  return text;
}

}  // namespace dynamic_icp::datasets
