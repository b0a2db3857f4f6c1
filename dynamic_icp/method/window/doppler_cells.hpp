// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/spatial/key_numbers.hpp"

namespace dynamic_icp::window {

/// Points of one sensor that were measured in nearly the same direction at nearly the same time: weighted means.
struct DopplerCell {
  Eigen::Vector3d u = Eigen::Vector3d::Zero();    ///< line of sight, sensor axes
  Eigen::Vector3d lxu = Eigen::Vector3d::Zero();  ///< m, lever arm of the sensor times u
  double s = 0.0;                                 ///< m/s, as measured
  double time_s = 0.0;                            ///< after the stamp
  double range_m = 0.0;
  double intensity = 0.0;  ///< as in the file; 0 without
  double weight = 0.0;     ///< s^2/m^2, inverse variance of the mean by the noise of single points
  double points = 0.0;     ///< sum of robust weights
  std::uint16_t line = 0;
  std::uint8_t face = 0;
  std::uint8_t sensor = 0;
};

/// How the Doppler of single points scatters, by range and intensity.
struct DopplerNoise {
  static constexpr std::size_t kRanges = 6;
  static constexpr std::size_t kIntensities = 4;

  std::vector<double> range_edges_m;    ///< quantiles of the first scan
  std::vector<double> intensity_edges;  ///< empty without intensities
  std::vector<double> variance;         ///< (m/s)^2 of each bin, ranges first

  [[nodiscard]] std::size_t bin(double range_m, double intensity) const;
};

/// Sorts the Doppler of static points into cells and weighs it.
class DopplerCells {
 public:
  /// Numbers the cells of the rows of `scan` with `is_moving` 0; `interval_s` is the longest time that may pass within
  /// one.
  void sort(const Scan& scan, const std::vector<std::uint8_t>& is_moving, double interval_s, const Workers& workers);

  /// The means over the cells of `measured` Doppler (m/s). Weights come from the scatter around the `predicted` one
  /// within each cell; rows beyond `gate_mps` of it have none. Learns the noise of points, too.
  const std::vector<DopplerCell>& average(const Scan& scan, const std::vector<double>& measured,
                                          const std::vector<double>& predicted, double gate_mps);

  [[nodiscard]] const std::vector<DopplerCell>& cells() const { return cells_; }

  /// What stands for the line of a point where the scan has none: its elevation in steps.
  static std::uint16_t line_of(const Eigen::Vector3d& u);

  [[nodiscard]] const DopplerNoise& noise() const { return noise_; }

 private:
  void learn_noise(const Scan& scan, const std::vector<double>& deviation);

  std::vector<std::uint64_t> key_;   ///< of each row
  spatial::KeyNumbers numbers_;      ///< of each key
  std::vector<std::uint32_t> cell_;  ///< of each row
  std::vector<double> range_;        ///< m, of each row
  std::vector<double> residual_;     ///< m/s
  std::vector<DopplerCell> cells_;
  std::vector<double> sums_;
  std::vector<double> counts_;
  std::size_t cell_count_ = 0;
  DopplerNoise noise_;
};

}  // namespace dynamic_icp::window
