// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kSteepest_rad = 0.35;  // against the last ground
constexpr std::size_t kMemory = 9;      // scans
constexpr double kFewGround = 0.25;     // at least this share of them shows the ground ...
constexpr double kSameHeight_m = 0.3;   // ... whose height changes by no more meanwhile

// Heights are sorted into bins in cells of the ground.
constexpr double kCell_m = 6.0;
constexpr int kMaxReach = 3;  // cells
constexpr double kBin_m = 0.05;
constexpr double kHighest_m = 1.0;               // of the lowest point that is seen of an object above the ground ...
constexpr double kDeepest_m = 0.3;               // ... and below it
constexpr std::size_t kMaxGroundPoints = 16384;  // of a scan: more would not make heights better
constexpr std::uint32_t kMinBinPoints = 6;       // of the bin with most points and its neighbours

}  // namespace

const Ground& GroundFilter::update(const Eigen::Vector3d& normal, double offset_m,
                                   const Eigen::Vector3d& sensor_world) {
  if (normal.dot(ground_.up()) < std::cos(kSteepest_rad)) {
    return ground_;
  }
  const Plane plane{normal, normal.dot(sensor_world) - offset_m};
  if (last_.size() < kMemory) {
    last_.push_back(plane);
  } else {
    last_[next_] = plane;
    next_ = (next_ + 1) % kMemory;
  }
  // What bounds a scene besides the ground passes below the ground near the carrier, so it is farther from the sensor.
  std::array<double, kMemory> values;
  std::transform(last_.begin(), last_.end(), values.begin(), [](const Plane& one) { return one.height_m; });
  const double highest_m = quantile_among(std::span(values).first(last_.size()), kFewGround) + kSameHeight_m;
  const auto median_of = [&](const auto& part) {
    std::size_t count = 0;
    for (const Plane& one : last_) {
      if (one.height_m <= highest_m) {
        values[count++] = part(one);
      }
    }
    return quantile_among(std::span(values).first(count), 0.5);
  };
  Eigen::Vector3d up;
  for (int axis = 0; axis < 3; ++axis) {
    up[axis] = median_of([&](const Plane& one) { return one.normal[axis]; });
  }
  up.normalize();
  // The shortest turn from the last normal to this one: headings in the ground stay what they are.
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(ground_.up(), up);
  ground_.level = turn.toRotationMatrix() * ground_.level;
  ground_.offset_m = up.dot(sensor_world) - median_of([](const Plane& one) { return one.height_m; });
  return ground_;
}

GroundHeights::GroundHeights(const Ground& ground, std::span<const Eigen::Vector3d> points,
                             std::span<const std::uint8_t> is_moving, const Eigen::Isometry3d& T_world_sensor)
    : ground_(ground), sensor_world_(T_world_sensor.translation()) {
  if (!ground.offset_m) {
    return;
  }
  const Eigen::Matrix3d R_level_sensor = ground.level.transpose() * T_world_sensor.linear();
  const double plane_z = *ground.offset_m - ground.up().dot(sensor_world_);
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kMaxGroundPoints);
  Bins bins;
  for (std::size_t begin = 0; begin < points.size(); begin += kBinBlock * stride) {
    const std::size_t count = Workers::block_count(std::min(kBinBlock * stride, points.size() - begin), stride);
    find_bins(&points[begin], stride, count, R_level_sensor, plane_z, bins);
    for (std::size_t i = 0; i < count; ++i) {
      if (bins.cell[i] >= 0 && is_moving[begin + i * stride] == 0) {
        std::uint16_t& points_there =
            cells_[static_cast<std::size_t>(bins.cell[i])][static_cast<std::size_t>(bins.bin[i])];
        points_there = static_cast<std::uint16_t>(std::min(points_there + 1, 0xffff));
      }
    }
  }
}

/// The bins of every `stride`th of some points (m, sensor frame).
void GroundHeights::find_bins(const Eigen::Vector3d* points, std::size_t stride, std::size_t count,
                              const Eigen::Matrix3d& R_level_sensor, double plane_z, Bins& bins) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const Eigen::Matrix3d R = R_level_sensor;
    const double* const p = points->data();
    const std::size_t step = 3 * stride;
    const std::size_t n = count;
    const double ground_z = plane_z;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = p[i * step];
      const double y = p[i * step + 1];
      const double z = p[i * step + 2];
      const auto along = [&](int axis)
                             DYNAMIC_ICP_KERNEL { return (R(axis, 0) * x + R(axis, 1) * y) + R(axis, 2) * z; };
      const double bin = (along(2) - ground_z) / kBin_m + 0.5 * kBins;
      const double column = along(0) / kCell_m + 0.5 * kCells;
      const double row = along(1) / kCell_m + 0.5 * kCells;
      const bool is_inside =
          (bin >= 0.0) & (bin < kBins) & (column >= 0.0) & (column < kCells) & (row >= 0.0) & (row < kCells);
      const int cell = static_cast<int>(is_inside ? row : 0.0) * kCells + static_cast<int>(is_inside ? column : 0.0);
      bins.cell[i] = is_inside ? cell : -1;
      bins.bin[i] = static_cast<int>(is_inside ? bin : 0.0);
    }
  });
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

Ground GroundHeights::below(const Eigen::Vector3d& lowest) const {
  Ground result = ground_;
  if (!ground_.offset_m) {
    return result;
  }
  // The nearest four cells, and where nothing is seen of the ground there, more of them.
  for (int reach = 1; reach <= kMaxReach; ++reach) {
    Histogram sum{};
    for (int x = -reach; x < reach; ++x) {
      for (int y = -reach; y < reach; ++y) {
        if (const auto cell = cell_of(in_level(lowest) + kCell_m * Eigen::Vector3d(x + 0.5, y + 0.5, 0.0))) {
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
    if (count >= kMinBinPoints) {
      *result.offset_m += height / count;
      return result;
    }
  }
  const double height = ground_.up().dot(lowest) - *ground_.offset_m;
  if (!(height > -kDeepest_m && height < kHighest_m)) {
    result.offset_m.reset();
  }
  return result;
}

void GroundFilter::state(StateArchive& archive) {
  archive.each(last_, [&](Plane& plane) { archive(plane.normal, plane.height_m); });
  archive(next_, ground_.level, ground_.offset_m);
  archive.require(last_.size() <= kMemory && next_ < kMemory, "the memory of the ground");
}

}  // namespace dynamic_icp::tracking
