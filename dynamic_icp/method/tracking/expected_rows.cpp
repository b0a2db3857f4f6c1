// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expected_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/coordinates.hpp"
#include "dynamic_icp/method/tracking/flags.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr double kRoundingOfPlaces_m = 0.01;  // more than rounding moves a point
constexpr std::size_t kRowsOfPatch = RangeImage::kPatch;
constexpr std::size_t kPatchesOfBlock = 8;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostSought = 64;  // bodies on the stack; more cost an allocation

/// A box in which rows are looked for.
struct SoughtBox {
  OrientedBox box;         ///< world, at the stamp
  Vector3d centre_sensor;  ///< m, sensor frame at the stamp
  Vector3d half_sensor;    ///< m, of the box around it along the axes of the sensor
  Vector3d drift_sensor;   ///< m/s, of the sensor against it
};

SoughtBox sought_box(const Expectation& expected, const SensorMotion& sensor) {
  SoughtBox sought;
  OrientedBox& box = sought.box = expected.box_above_ground();
  box.size.head<2>().array() += 2.0 * expected.gate_m;
  box.size.z() += expected.gate_m;
  box.centre += 0.5 * expected.gate_m * box.axes.col(2);
  const Eigen::Isometry3d T_sensor_world = sensor.T_world_sensor.inverse();
  sought.centre_sensor = T_sensor_world * box.centre;
  sought.half_sensor = 0.5 * aligned_extent({box.centre, T_sensor_world.linear() * box.axes, box.size});
  sought.drift_sensor = T_sensor_world.linear() * (sensor.velocity_world - expected.velocity);
  return sought;
}

/// Where and when some rows of a scan were measured.
struct Whereabouts {
  Eigen::AlignedBox3d around;         ///< m, sensor frames
  Interval seconds{kNever, -kNever};  ///< after the stamp

  void extend(const Whereabouts& other) {
    around.extend(other.around);
    seconds = {std::min(seconds.low, other.seconds.low), std::max(seconds.high, other.seconds.high)};
  }

  /// How far the turn of the sensor since the stamp may move them, m.
  [[nodiscard]] double turned_m(const SensorMotion& sensor) const {
    const double latest_s = std::max(std::abs(seconds.low), std::abs(seconds.high));
    const double turned_rad = latest_s * sensor.angular_velocity_sensor.norm();
    return turned_rad * (1.0 + 0.5 * turned_rad) * around.min().cwiseAbs().cwiseMax(around.max().cwiseAbs()).norm();
  }

  /// Whether some of them may be in a box, as far as they may be moved.
  [[nodiscard]] bool may_meet(const SoughtBox& sought, double moved_m) const {
    const Eigen::Array3d place = sought.centre_sensor - seconds.middle() * sought.drift_sensor;
    const Eigen::Array3d reach =
        (sought.half_sensor + 0.5 * seconds.length() * sought.drift_sensor.cwiseAbs()).array() +
        (moved_m + kRoundingOfPlaces_m);
    return (place + reach >= around.min().array()).all() && (place - reach <= around.max().array()).all();
  }
};

/// Points of a patch with the times of their measurement.
struct TimedPatch {
  std::array<double, kRowsOfPatch> x;  ///< m
  std::array<double, kRowsOfPatch> y;
  std::array<double, kRowsOfPatch> z;
  std::array<double, kRowsOfPatch> time;  ///< s after the stamp
  std::size_t count = 0;
};

/// Some rows of a scan as they are, sensor frame.
void take_patch(const Scan& scan, std::size_t begin, std::size_t count, TimedPatch& patch) {
  patch.count = count;
  patch.time.fill(0.0);
  if (scan.has_times()) {
    std::copy_n(&scan.times()[begin], count, patch.time.begin());
  }
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = count;
    const double* const p = scan.points()[begin].data();
    for (std::size_t i = 0; i < n; ++i) {
      patch.x[i] = p[3 * i];
      patch.y[i] = p[3 * i + 1];
      patch.z[i] = p[3 * i + 2];
    }
  });
}

/// Where the points were seen, world, as SensorMotion::point_world says it.
void put_into_world(const SensorMotion& sensor, TimedPatch& patch) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = patch.count;
    const Eigen::Matrix3d R = sensor.T_world_sensor.linear();
    const Vector3d origin = sensor.T_world_sensor.translation();
    const Vector3d velocity = sensor.velocity_world;
    const Vector3d omega = sensor.angular_velocity_sensor;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = patch.time[i];
      const double ax = t * omega.x();
      const double ay = t * omega.y();
      const double az = t * omega.z();
      const double fx = ay * patch.z[i] - az * patch.y[i];
      const double fy = az * patch.x[i] - ax * patch.z[i];
      const double fz = ax * patch.y[i] - ay * patch.x[i];
      const double x = patch.x[i] + fx + 0.5 * (ay * fz - az * fy);
      const double y = patch.y[i] + fy + 0.5 * (az * fx - ax * fz);
      const double z = patch.z[i] + fz + 0.5 * (ax * fy - ay * fx);
      patch.x[i] = origin.x() + t * velocity.x() + (R(0, 0) * x + R(0, 1) * y + R(0, 2) * z);
      patch.y[i] = origin.y() + t * velocity.y() + (R(1, 0) * x + R(1, 1) * y + R(1, 2) * z);
      patch.z[i] = origin.z() + t * velocity.z() + (R(2, 0) * x + R(2, 1) * y + R(2, 2) * z);
    }
  });
}

/// Whether each point of a patch is in a box that moves with this velocity (m/s), all in one frame.
void find_inside(const TimedPatch& patch, const OrientedBox& box, const Vector3d& velocity,
                 std::array<std::uint8_t, kRowsOfPatch>& is_inside) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = patch.count;
    const Eigen::Matrix3d axes = box.axes;
    const Vector3d centre = box.centre;
    const Vector3d v = velocity;
    const Vector3d half = 0.5 * box.size;
    std::array<double, kRowsOfPatch> beyond;  // the farthest of the faces, m
    for (std::size_t i = 0; i < n; ++i) {
      const double x = patch.x[i] - patch.time[i] * v.x() - centre.x();
      const double y = patch.y[i] - patch.time[i] * v.y() - centre.y();
      const double z = patch.z[i] - patch.time[i] * v.z() - centre.z();
      const auto outside = [&](int axis) DYNAMIC_ICP_KERNEL {
        return std::abs(axes(0, axis) * x + axes(1, axis) * y + axes(2, axis) * z) - half[axis];
      };
      const double level = outside(0) > outside(1) ? outside(0) : outside(1);
      beyond[i] = level > outside(2) ? level : outside(2);
    }
    for (std::size_t i = 0; i < n; ++i) {
      is_inside[i] = beyond[i] <= 0.0 ? 1 : 0;
    }
  });
}

}  // namespace

void flag_rows(const Scan& scan, std::span<const double> radial, const SensorMotion& sensor,
               std::span<const Expectation> expectations, const Workers& workers,
               std::vector<std::uint8_t>& is_moving) {
  StackMemory<kMostSought * sizeof(SoughtBox)> memory;
  std::pmr::vector<SoughtBox> sought(memory.resource());
  sought.reserve(expectations.size());
  for (const Expectation& expected : expectations) {
    sought.push_back(sought_box(expected, sensor));
  }
  const auto flag_patch = [&](std::size_t begin, const TimedPatch& patch, std::size_t k) {
    std::array<std::uint8_t, kRowsOfPatch> is_inside;
    find_inside(patch, sought[k].box, expectations[k].velocity, is_inside);
    visit_flagged(is_inside, 0, patch.count, [&](std::size_t i) {
      const std::size_t row = begin + i;
      if (is_moving[row] == 0 &&
          expectations[k].gate_ratio(sensor.direction_world(scan.directions()[row], patch.time[i]), radial[row]) <
              1.0) {
        is_moving[row] = 1;
      }
    });
  };
  // Few blocks of rows are near any body, and few patches of these.
  const auto flag_block = [&](std::size_t begin, std::size_t end) {
    std::array<Whereabouts, kPatchesOfBlock> patches;
    Whereabouts block;
    for (std::size_t row = begin; row < end; row += kRowsOfPatch) {
      const std::size_t count = std::min(kRowsOfPatch, end - row);
      Whereabouts& where = patches[(row - begin) / kRowsOfPatch];
      where.around = box_around(&scan.points()[row], count);
      where.seconds = scan.has_times() ? interval_around(std::span(scan.times()).subspan(row, count)) : Interval{};
      block.extend(where);
    }
    const double turned_m = block.turned_m(sensor);
    if (std::none_of(sought.begin(), sought.end(),
                     [&](const SoughtBox& one) { return block.may_meet(one, turned_m); })) {
      return;
    }
    for (std::size_t row = begin; row < end; row += kRowsOfPatch) {
      const Whereabouts& where = patches[(row - begin) / kRowsOfPatch];
      const double where_turned_m = where.turned_m(sensor);
      TimedPatch patch;
      for (std::size_t k = 0; k < sought.size(); ++k) {
        if (!where.may_meet(sought[k], where_turned_m)) {
          continue;
        }
        if (patch.count == 0) {
          take_patch(scan, row, std::min(kRowsOfPatch, end - row), patch);
          put_into_world(sensor, patch);
        }
        flag_patch(row, patch, k);
      }
    }
  };
  constexpr std::size_t kRowsOfBlock = kPatchesOfBlock * kRowsOfPatch;
  workers.for_blocks(sought.empty() ? 0 : scan.size(), kPointBlock,
                     [&](std::size_t, std::size_t block_begin, std::size_t block_end) {
                       for (std::size_t begin = block_begin; begin < block_end; begin += kRowsOfBlock) {
                         flag_block(begin, std::min(begin + kRowsOfBlock, block_end));
                       }
                     });
}

void find_static_rows(const TrackingInput& input, const Expectation& expected, std::vector<std::uint32_t>& rows) {
  rows.clear();
  const Eigen::Isometry3d T_sensor_world = input.sensor.T_world_sensor.inverse();
  OrientedBox box = expected.box_above_ground();  // in the frame of the points
  box.centre = T_sensor_world * box.centre;
  box.axes = T_sensor_world.linear() * box.axes;
  const Vector3d velocity = T_sensor_world.linear() * expected.velocity;
  // What moves during the sweep is not seen where it is at the stamp.
  const Vector3d half = 0.5 * aligned_extent(box) + input.sweep_s * velocity.cwiseAbs();
  const Vector3d reach = half + Vector3d::Constant(kRoundingOfPlaces_m);
  input.view.visit_patches({box.centre - reach, box.centre + reach}, [&](std::size_t begin, std::size_t end) {
    TimedPatch patch;
    take_patch(input.scan, begin, end - begin, patch);
    std::array<std::uint8_t, kRowsOfPatch> is_inside;
    find_inside(patch, box, velocity, is_inside);
    visit_flagged(is_inside, 0, patch.count, [&](std::size_t i) {
      if (input.is_moving[begin + i] == 0) {
        rows.push_back(static_cast<std::uint32_t>(begin + i));
      }
    });
  });
}

}  // namespace dynamic_icp::tracking
