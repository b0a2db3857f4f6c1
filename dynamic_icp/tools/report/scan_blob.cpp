// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/scan_blob.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dynamic_icp/recording/formats/base64.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/tools/report/zlib_stream.hpp"

namespace dynamic_icp::report {
namespace {

constexpr double kFinest_m = 0.002;  // far below the noise of the range
constexpr double kMapUnit_m = 0.01;
constexpr double kDopplerUnit_mps = 0.01;
constexpr double kResidualUnit_m = 0.005;
constexpr std::int64_t kLargest16 = std::numeric_limits<std::int16_t>::max();

/// The finest unit in which all coordinates fit 16 bits; as it will be read, in single precision.
float unit_of(const std::vector<Eigen::Vector3d>& points) {
  double largest = 0.0;
  for (const Eigen::Vector3d& point : points) {
    largest = std::max(largest, point.cwiseAbs().maxCoeff());
  }
  constexpr double kRoomForRounding = 1e-6;
  return static_cast<float>(std::max(kFinest_m, largest / static_cast<double>(kLargest16) * (1.0 + kRoomForRounding)));
}

std::vector<std::int64_t> in_units(const std::vector<Eigen::Vector3d>& points, int axis, double origin, double unit) {
  std::vector<std::int64_t> column;
  column.reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    column.push_back(std::llround((point[axis] - origin) / unit));
  }
  return column;
}

/// Appends each value of a column as its difference to the one before, modulo the range of `Unsigned`; the first one as
/// the difference to 0.
template <class Unsigned>
void append_differences(std::string& bytes, const std::vector<std::int64_t>& column) {
  std::int64_t before = 0;
  for (const std::int64_t value : column) {
    formats::append_value(bytes, static_cast<Unsigned>(value - before));
    before = value;
  }
}

/// Speeds in 0.01 m/s, limited; `unknown` for those that are not finite.
void append_speeds(std::string& bytes, const std::vector<double>& speeds, std::int64_t unknown) {
  for (const double speed : speeds) {
    const double limit = static_cast<double>(kLargest16);
    const std::int64_t value =
        std::isfinite(speed) ? std::llround(std::clamp(speed / kDopplerUnit_mps, -limit, limit)) : unknown;
    formats::append_value(bytes, static_cast<std::uint16_t>(value));
  }
}

std::uint8_t residual_byte(double distance_m) {
  constexpr std::int64_t kMore = 254;
  constexpr std::uint8_t kNoSurface = 255;
  return std::isfinite(distance_m)
             ? static_cast<std::uint8_t>(std::min(std::llround(distance_m / kResidualUnit_m), kMore + 0LL))
             : kNoSurface;
}

}  // namespace

std::string scan_bytes(const figures::ShownScan& scan) {
  std::string bytes;
  bytes.reserve(8 + 12 * scan.size());
  formats::append_value(bytes, static_cast<std::uint32_t>(scan.size()));
  const float unit = unit_of(scan.points);
  formats::append_value(bytes, unit);
  for (int axis = 0; axis < 3; ++axis) {
    append_differences<std::uint16_t>(bytes, in_units(scan.points, axis, 0.0, unit));
  }
  append_speeds(bytes, scan.doppler, 0);
  append_speeds(bytes, scan.compensated, std::numeric_limits<std::int16_t>::min());
  for (const std::uint8_t label : scan.labels) {
    bytes.push_back(static_cast<char>(label));
  }
  for (const double distance : scan.residual) {
    bytes.push_back(static_cast<char>(residual_byte(distance)));
  }
  return bytes;
}

std::string map_bytes(const std::vector<Eigen::Vector3d>& points) {
  std::string bytes;
  formats::append_value(bytes, static_cast<std::uint32_t>(points.size()));
  const auto unit = static_cast<float>(kMapUnit_m);
  formats::append_value(bytes, unit);
  Eigen::Vector3d origin = points.empty() ? Eigen::Vector3d::Zero() : points.front();
  for (const Eigen::Vector3d& point : points) {
    origin = origin.cwiseMin(point);
  }
  for (int axis = 0; axis < 3; ++axis) {
    formats::append_value(bytes, origin[axis]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    append_differences<std::uint32_t>(bytes, in_units(points, axis, origin[axis], unit));
  }
  return bytes;
}

std::string blob(const std::string& bytes) { return formats::base64(zlib_stream(bytes)); }

}  // namespace dynamic_icp::report
