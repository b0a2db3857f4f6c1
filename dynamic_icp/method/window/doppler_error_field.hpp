// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/window/doppler_cells.hpp"
#include "dynamic_icp/method/window/variance_posterior.hpp"
#include "dynamic_icp/method/window/window_config.hpp"

namespace dynamic_icp::window {

/// The columns of one measurement that are not zero: b = sum value[k] theta[index[k]].
struct FieldColumns {
  static constexpr std::size_t kCapacity = 16;
  std::array<std::uint32_t, kCapacity> index{};
  std::array<double, kCapacity> value{};
  std::size_t size = 0;

  void add(std::size_t column, double weight) {
    index[size] = static_cast<std::uint32_t>(column);
    value[size++] = weight;
  }

  [[nodiscard]] double dot(const Eigen::VectorXd& theta) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < size; ++k) {
      sum += value[k] * theta[index[k]];
    }
    return sum;
  }
};

/// What a sensor's Doppler errs by, b = Phi(direction, line, face, range, intensity) theta (m/s):
///
///   azimuth     piecewise constant over the field of view, exponential kernel: steps as well as smooth shapes
///   cross       bilinear in azimuth and elevation
///   line, face  a constant each, where the scan has them; without faces one constant
///   range       linear, and near the sensor; intensity: linear
///   velocity    columns -u: the part of the error that looks like a motion of the sensor
///
/// A priori theta_g ~ N(0, tau_g^2 K_g) in each group g. The scale tau_g is learned from what the data show of the
/// group (of the constant, which may well be large or zero, with a wide prior); that of the velocity-like part follows
/// those of the directions, because what can be seen of an error tells how large the part is that cannot.
class DopplerErrorField {
 public:
  explicit DopplerErrorField(const FieldShape& shape);

  /// For the sensors, directions and lines that these cells show, and so many faces.
  DopplerErrorField(const std::vector<DopplerCell>& cells, std::size_t faces)
      : DopplerErrorField(shape_of(cells, faces)) {}

  static FieldShape shape_of(const std::vector<DopplerCell>& cells, std::size_t faces);
  [[nodiscard]] const FieldShape& shape() const { return shape_; }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] FieldColumns columns(const DopplerCell& cell) const;

  /// Of all cells; the memory of `result` is used again.
  void columns(const std::vector<DopplerCell>& cells, const Workers& workers, std::vector<FieldColumns>& result) const;

  /// Those that points seen in nearly the same direction share, and those that each has for itself.
  [[nodiscard]] FieldColumns shared_columns(const DopplerCell& cell) const;
  void add_own_columns(const DopplerCell& cell, FieldColumns& columns) const;

  /// The error by the columns that a point has for itself, m/s; that of short ranges no larger than any sensor has.
  [[nodiscard]] double own_error(std::size_t sensor, const Eigen::Vector3d& u, double range_m, double intensity,
                                 const Eigen::VectorXd& theta) const;

  /// The error by line and face, or the constant one, m/s; of the sensors of a rig it is part of that by azimuth, and
  /// 0.
  [[nodiscard]] double channel_error(const DopplerCell& cell, const Eigen::VectorXd& theta) const;

  [[nodiscard]] double at(const DopplerCell& cell, const Eigen::VectorXd& theta) const {
    return columns(cell).dot(theta);
  }

  /// Adds the information of the prior to the first rows and columns of H.
  void add_prior_information(Eigen::Ref<Eigen::MatrixXd> H) const;

  /// Adds its gradient at theta to the first rows of g.
  void add_prior_gradient(const Eigen::VectorXd& theta, Eigen::Ref<Eigen::VectorXd> g) const;

  /// Learns the scales from an estimate and its covariance P = M M^T, by MacKay's fixed point
  /// tau^2 = theta^T K^-1 theta / (n - tr(K^-1 P) / tau^2). That of the velocity-like part follows the others, and the
  /// share of the azimuths of each sensor that were hidden (DopplerCells): all may be well in the rest of the view.
  void learn_scales(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance_root,
                    std::span<const double> hidden_azimuths);

  struct Group {
    std::string_view name;
    std::size_t begin = 0;
    Eigen::MatrixXd K;             ///< correlation
    Eigen::MatrixXd inverse;       ///< of it
    Eigen::MatrixXd inverse_root;  ///< L with the inverse L L^T
    double tau = 0.05;             ///< m/s
    bool is_learned = true;
    double max_tau = 0.0;                         ///< m/s, of what is learned
    std::optional<VariancePrior> tau_prior = {};  ///< of tau^2, of a group of one column
    [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(K.rows()); }
  };
  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
  [[nodiscard]] std::vector<Group>& groups() { return groups_; }

 private:
  struct SensorColumns {
    std::size_t azimuth = 0, cross = 0, line = 0, face = 0, range = 0, velocity = 0;
  };

  void add_channel_columns(const DopplerCell& cell, FieldColumns& columns) const;
  [[nodiscard]] Eigen::Vector3d by_range_and_intensity(double range_m, double intensity) const;
  std::size_t add_group(std::string_view name, Eigen::MatrixXd K, double tau, bool is_learned);

  FieldShape shape_;
  std::vector<SensorColumns> sensors_;
  std::vector<Group> groups_;
  std::size_t size_ = 0;
  std::size_t azimuths_ = 0;
};

}  // namespace dynamic_icp::window
