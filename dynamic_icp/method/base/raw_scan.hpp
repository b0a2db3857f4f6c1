// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/eigen_layout.hpp"
#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp {

/// What the Doppler of a recording says.
enum class DopplerKind : std::uint8_t {
  kRelative,    ///< as measured: the sensor's own motion is in it, s = u.(v_object - v_sensor)
  kCompensated  ///< the sensor's own motion was taken out before, s = u.v_object
};
constexpr DopplerKind last_of(DopplerKind /*any*/) { return DopplerKind::kCompensated; }

/// What a sensor says of each point beside position, Doppler and time. A column is empty where the data has none, else
/// as long as the points.
struct Channels {
  std::vector<std::uint8_t> sensor;         ///< of a rig: index into its mountings
  std::vector<std::uint16_t> line;          ///< scan line, ring or beam, as the file numbers them
  std::vector<std::uint8_t> face;           ///< of a rotating mirror
  std::vector<float> intensity;             ///< intensity, reflectivity or radar cross section, in the unit of the file
  std::vector<std::uint8_t> return_number;  ///< 0: the first or only return of a beam
};

/// A scan as a reader hands it over: columns of equal length, nothing checked yet.
struct RawScan {
  Stamp stamp;                              ///< when the scan begins
  std::vector<Eigen::Vector3d> points;      ///< m, sensor frame; of a rig the common frame of its sensors
  std::vector<double> doppler;              ///< m/s, range rate, positive away from the sensor
  std::vector<double> times;                ///< s after `stamp`, per point; empty where the data has none
  std::vector<Eigen::Vector3d> directions;  ///< lines of sight where they are not points/|points|; else empty
  Channels channels;
  std::vector<std::uint8_t> is_unusable;     ///< 1: the sensor itself flags the point as no measurement; or empty
  std::vector<Eigen::Isometry3d> mountings;  ///< T_scan_sensor by `channels.sensor`; empty: one sensor at the origin
  DopplerKind doppler_kind = DopplerKind::kRelative;
  std::string warning;  ///< what the reader found odd but could live with; empty: nothing
};

/// Numbers in the memory of the caller: float or double, at equal distances.
class Column {
 public:
  Column() = default;

  /// `size` numbers, the first at `first`, `stride_bytes` apart; negative where they lie backwards in memory.
  template <class Number>
  requires(std::same_as<Number, float> || std::same_as<Number, double>)
      Column(const Number* first, std::size_t size, std::ptrdiff_t stride_bytes = sizeof(Number))
      : first_(reinterpret_cast<const std::byte*>(first)),
        size_(size),
        stride_bytes_(stride_bytes),
        is_float_(std::same_as<Number, float>) {}

  Column(const std::vector<double>& numbers) : Column(numbers.data(), numbers.size()) {}
  Column(const std::vector<float>& numbers) : Column(numbers.data(), numbers.size()) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }

  double operator[](std::size_t i) const {
    const std::byte* const at = first_ + static_cast<std::ptrdiff_t>(i) * stride_bytes_;
    if (is_float_) {
      float number = 0.0F;
      std::memcpy(&number, at, sizeof number);
      return static_cast<double>(number);
    }
    double number = 0.0;
    std::memcpy(&number, at, sizeof number);
    return number;
  }

 private:
  const std::byte* first_ = nullptr;
  std::size_t size_ = 0;
  std::ptrdiff_t stride_bytes_ = 0;
  bool is_float_ = false;
};

/// Three columns: the coordinates of points or of directions.
struct VectorColumns {
  VectorColumns() = default;
  VectorColumns(Column x_values, Column y_values, Column z_values) : x(x_values), y(y_values), z(z_values) {}
  VectorColumns(const std::vector<Eigen::Vector3d>& vectors);

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool empty() const { return x.empty(); }
  Eigen::Vector3d operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }

  Column x;
  Column y;
  Column z;
};

/// A scan in the memory of the caller, for instance in a message of a driver: nothing is copied, and nothing is kept
/// after the call that it is passed to. The members are those of RawScan.
struct ScanView {
  ScanView() = default;
  ScanView(const RawScan& raw);

  Stamp stamp;
  VectorColumns points;
  Column doppler;
  Column times;
  VectorColumns directions;
  std::span<const std::uint8_t> sensor;
  std::span<const std::uint16_t> line;
  std::span<const std::uint8_t> face;
  std::span<const float> intensity;
  std::span<const std::uint8_t> return_number;
  std::span<const std::uint8_t> is_unusable;
  std::span<const Eigen::Isometry3d> mountings;
  DopplerKind doppler_kind = DopplerKind::kRelative;
};

/// Throws std::invalid_argument, naming the lengths, when columns differ in length or a sensor has no mounting.
void check_columns(const ScanView& scan);

}  // namespace dynamic_icp
