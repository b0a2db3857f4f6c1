// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/expected_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory_resource>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/flags.hpp"
#include "dynamic_icp/method/tracking/memory.hpp"
#include "dynamic_icp/method/tracking/patches.hpp"

namespace dynamic_icp::tracking {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kUsualBodies = 128;  // bodies on the stack; more cost an allocation
constexpr std::size_t kTogether = 16;      // bodies for which points are put into the world at once

/// A box in which rows are looked for.
struct SoughtBox {
  OrientedBox box;    ///< world, at the stamp
  SoughtPlace place;  ///< of the box, seen from the sensor
};

OrientedBox moved_by(const Eigen::Isometry3d& T, const OrientedBox& box) {
  return {T * box.centre, T.linear() * box.axes, box.size};
}

SoughtBox sought_box(const Expectation& expected, const SensorMotion& sensor) {
  OrientedBox box = expected.box_above_ground();
  box.size.head<2>().array() += 2.0 * expected.gate_m;
  box.size.z() += expected.gate_m;
  box.centre += 0.5 * expected.gate_m * box.axes.col(2);
  const Eigen::Isometry3d T_sensor_world = sensor.T_world_sensor.inverse();
  const Vector3d drift = T_sensor_world.linear() * (expected.velocity - sensor.velocity_world);
  return {box, place_of(moved_by(T_sensor_world, box), drift, sensor.angular_velocity_sensor.norm())};
}

/// Points of a patch with the times of their measurement.
struct TimedPatch {
  std::array<double, PatchBlock::kRows> x;  ///< m
  std::array<double, PatchBlock::kRows> y;
  std::array<double, PatchBlock::kRows> z;
  std::array<double, PatchBlock::kRows> time;  ///< s after the stamp
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
                 std::array<std::uint8_t, PatchBlock::kRows>& is_inside) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = patch.count;
    const Eigen::Matrix3d axes = box.axes;
    const Vector3d centre = box.centre;
    const Vector3d v = velocity;
    const Vector3d half = 0.5 * box.size;
    std::array<double, PatchBlock::kRows> beyond;  // the farthest of the faces, m
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

void flag_rows(const Scan& scan, const ScanPatches& patches, std::span<const double> radial, const SensorMotion& sensor,
               std::span<const Expectation> expectations, const Workers& workers,
               std::vector<std::uint8_t>& is_moving) {
  StackMemory<kUsualBodies * sizeof(SoughtBox)> memory;
  std::pmr::vector<SoughtBox> sought(memory.resource());
  sought.reserve(expectations.size());
  for (const Expectation& expected : expectations) {
    sought.push_back(sought_box(expected, sensor));
  }
  const auto flag_patch = [&](std::size_t begin, const TimedPatch& patch, std::size_t k) {
    std::array<std::uint8_t, PatchBlock::kRows> is_inside;
    find_inside(patch, sought[k].box, expectations[k].velocity, is_inside);
    visit_flagged(is_inside, 0, patch.count, [&](std::size_t i) {
      const std::size_t row = begin + i;
      const auto is_expected = [&] {
        const Vector3d direction = sensor.direction_world(scan.directions()[row], patch.time[i]);
        return expectations[k].gate_ratio(direction, radial[row]) < 1.0;
      };
      if (is_moving[row] == 0 && is_expected()) {
        is_moving[row] = 1;
      }
    });
  };
  // Few patches are near any body. Their points are put into the world for some bodies together.
  const auto flag_block = [&](std::size_t block, std::size_t begin, std::size_t end) {
    const PatchBlock& bounds = patches.blocks()[block];
    for (std::size_t first = 0; first < sought.size(); first += kTogether) {
      const std::size_t together = std::min(kTogether, sought.size() - first);
      std::array<PatchBlock::Flags, kTogether> may_hold;
      PatchBlock::Flags is_needed{};
      for (std::size_t k = 0; k < together; ++k) {
        bounds.find(sought[first + k].place, may_hold[k]);
        for (std::size_t patch = 0; patch < bounds.count(); ++patch) {
          is_needed[patch] |= may_hold[k][patch];
        }
      }
      visit_flagged(is_needed, 0, bounds.count(), [&](std::size_t patch) {
        const std::size_t row = begin + patch * PatchBlock::kRows;
        const std::size_t count = std::min(PatchBlock::kRows, end - row);
        if (count_flagged(is_moving, row, row + count) == count) {
          return;  // all of them move anyway
        }
        TimedPatch points;
        take_patch(scan, row, count, points);
        put_into_world(sensor, points);
        for (std::size_t k = 0; k < together; ++k) {
          if (may_hold[k][patch] != 0) {
            flag_patch(row, points, first + k);
          }
        }
      });
    }
  };
  workers.for_blocks(sought.empty() ? 0 : scan.size(), PatchBlock::kBlock, flag_block);
}

void find_static_rows(const TrackingInput& input, const Expectation& expected, std::vector<std::uint32_t>& rows) {
  rows.clear();
  const Eigen::Isometry3d T_sensor_world = input.sensor.T_world_sensor.inverse();
  const OrientedBox box = moved_by(T_sensor_world, expected.box_above_ground());
  const Vector3d velocity = T_sensor_world.linear() * expected.velocity;
  input.patches.visit(place_of(box, velocity, 0.0), [&](std::size_t begin, std::size_t end) {
    TimedPatch patch;
    take_patch(input.scan, begin, end - begin, patch);
    std::array<std::uint8_t, PatchBlock::kRows> is_inside;
    find_inside(patch, box, velocity, is_inside);
    visit_flagged(is_inside, 0, patch.count, [&](std::size_t i) {
      if (input.is_moving[begin + i] == 0) {
        rows.push_back(static_cast<std::uint32_t>(begin + i));
      }
    });
  });
}

}  // namespace dynamic_icp::tracking
