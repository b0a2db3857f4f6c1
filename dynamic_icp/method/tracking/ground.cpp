// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace dynamic_icp::tracking {
namespace {

constexpr double kSteepest_rad = 0.35;  // against the last ground
constexpr double kGain = 0.2;           // of a new normal

// Heights are sorted into bins in cells of the ground.
constexpr double kCell_m = 6.0;
constexpr double kBin_m = 0.05;
constexpr std::size_t kMaxPoints = 16384;   // of a scan: more would not make heights better
constexpr std::uint32_t kFewestPoints = 6;  // of the bin with most points and its neighbours

}  // namespace

Ground updated_ground(const Ground& last, const Eigen::Vector3d& normal, double offset_m,
                      const Eigen::Vector3d& sensor_world) {
  if (normal.dot(last.up()) < std::cos(kSteepest_rad)) {
    return last;
  }
  const Eigen::Vector3d up =
      last.offset_m ? Eigen::Vector3d((1.0 - kGain) * last.up() + kGain * normal).normalized() : normal;
  // The shortest turn from the last normal to this one: headings in the ground stay what they are.
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(last.up(), up);
  const Eigen::Vector3d below_sensor = sensor_world - (normal.dot(sensor_world) - offset_m) * normal;
  return {turn.toRotationMatrix() * last.level, up.dot(below_sensor)};
}

GroundHeights::GroundHeights(const Ground& ground, std::span<const Eigen::Vector3d> points,
                             std::span<const std::uint8_t> is_moving, const Eigen::Isometry3d& T_world_sensor)
    : ground_(ground), sensor_world_(T_world_sensor.translation()) {
  if (!ground.offset_m) {
    return;
  }
  const Eigen::Matrix3d R_level_sensor = ground.level.transpose() * T_world_sensor.linear();
  const double plane_z = *ground.offset_m - ground.up().dot(sensor_world_);
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kMaxPoints);
  for (std::size_t row = 0; row < points.size(); row += stride) {
    if (is_moving[row] != 0) {
      continue;
    }
    const Eigen::Vector3d x = R_level_sensor * points[row];
    const double bin = (x.z() - plane_z) / kBin_m + 0.5 * kBins;
    if (const auto cell = cell_of(x); cell && bin >= 0.0 && bin < kBins) {
      std::uint16_t& count = cells_[*cell][static_cast<std::size_t>(bin)];
      count = static_cast<std::uint16_t>(std::min(count + 1, 0xffff));
    }
  }
}

Eigen::Vector3d GroundHeights::in_level(const Eigen::Vector3d& point_world) const {
  return ground_.level.transpose() * (point_world - sensor_world_);
}

std::optional<std::size_t> GroundHeights::cell_of(const Eigen::Vector3d& from_sensor) const {
  const Eigen::Array2d place = from_sensor.head<2>().array() / kCell_m + 0.5 * kCells;
  if (!(place.minCoeff() >= 0.0 && place.maxCoeff() < kCells)) {
    return std::nullopt;
  }
  return static_cast<std::size_t>(place.y()) * kCells + static_cast<std::size_t>(place.x());
}

Ground GroundHeights::around(const Eigen::Vector3d& point) const {
  Ground result = ground_;
  if (!ground_.offset_m) {
    return result;
  }
  Histogram sum{};
  for (const double dx : {-0.5, 0.5}) {  // of the four cells nearest to the point
    for (const double dy : {-0.5, 0.5}) {
      if (const auto cell = cell_of(in_level(point) + kCell_m * Eigen::Vector3d(dx, dy, 0.0))) {
        for (std::size_t i = 0; i < sum.size(); ++i) {
          sum[i] = static_cast<std::uint16_t>(std::min(sum[i] + cells_[*cell][i], 0xffff));
        }
      }
    }
  }
  const auto most = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  std::uint32_t count = 0;
  double height = 0.0;
  for (std::size_t i = most > 0 ? most - 1 : 0; i <= std::min(most + 1, sum.size() - 1); ++i) {
    count += sum[i];
    height += sum[i] * kBin_m * (static_cast<double>(i) + 0.5 - 0.5 * kBins);
  }
  if (count >= kFewestPoints) {
    *result.offset_m += height / count;
  }
  return result;
}

}  // namespace dynamic_icp::tracking
