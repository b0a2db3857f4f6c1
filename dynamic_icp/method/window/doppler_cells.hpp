// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/spatial/cell_order.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::window {

/// Tukey's kernel around the mean of a cell and around the motion, in standard deviations.
inline constexpr double kDopplerKernel = 4.5;

/// The block of a loop over cells.
inline constexpr std::size_t kCellBlock = 128;

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
  /// Finds the cells of all points of a scan; `interval_s` is the longest time that may pass within one.
  void sort(const Scan& scan, double interval_s, const Workers& workers);

  /// The means over the cells of the `measured` Doppler (m/s) of points with `is_moving` 0. Weights come from the
  /// scatter around the `predicted` one within each cell; points beyond `gate_mps` of it have none. Learns the noise of
  /// points, too.
  const std::vector<DopplerCell>& average(const Scan& scan, const std::vector<std::uint8_t>& is_moving,
                                          const std::vector<double>& measured, const std::vector<double>& predicted,
                                          double gate_mps, const Workers& workers);

  /// The points of each cell of the scan that was sorted.
  [[nodiscard]] std::size_t count() const { return order_.cells(); }
  [[nodiscard]] std::span<const std::uint32_t> points(std::size_t cell) const {
    return std::span(points_).subspan(order_.first[cell], order_.first[cell + 1] - order_.first[cell]);
  }

  [[nodiscard]] double range_m(std::size_t point) const { return range_[point]; }

  [[nodiscard]] const std::vector<DopplerCell>& cells() const { return cells_; }

  /// For each sensor the share of its azimuths in which nearly nothing had a weight at the last `average`: what moves
  /// hides what stands.
  [[nodiscard]] std::vector<double> hidden_azimuths(const Scan& scan) const;

  /// What stands for the line of a point where the scan has none: its elevation in steps.
  static std::uint16_t line_of(const Eigen::Vector3d& u);

  [[nodiscard]] const DopplerNoise& noise() const { return noise_; }

  /// What was learned of the noise.
  void state(StateArchive& archive);

 private:
  void find_bins(const Scan& scan, const Workers& workers);
  void learn_noise(const Scan& scan);
  [[nodiscard]] DopplerCell mean_of(std::size_t cell, const Scan& scan, const std::vector<double>& measured) const;

  spatial::CellOrder order_;
  std::vector<std::uint32_t> points_;  ///< cell by cell
  std::vector<double> range_;          ///< m, of each point
  std::vector<std::uint8_t> bin_;      ///< of the noise, of each point; empty: not known yet
  std::vector<double> residual_;       ///< m/s, of each point from the mean of its cell; not a number: has no weight
  std::vector<double> counts_;         ///< of the points in a cell that have one
  std::vector<DopplerCell> cells_;
  DopplerNoise noise_;
};

}  // namespace dynamic_icp::window
