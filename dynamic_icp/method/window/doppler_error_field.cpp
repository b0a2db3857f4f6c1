// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/doppler_error_field.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace dynamic_icp::window {
namespace {

constexpr std::size_t kFieldBlock = 256;

constexpr std::size_t kAzimuths = 48;
constexpr std::size_t kCrossAzimuths = 12;
constexpr std::size_t kCrossElevations = 4;
constexpr std::size_t kRigAzimuths = 16;  // of each of several sensors
constexpr std::size_t kMaxFieldLines = 128;
constexpr double kCorrelation_rad = 0.35;  // of the error in azimuth
constexpr double kMargin_rad = 0.02;

constexpr double kRangeScale_m = 100.0;
constexpr double kRangeMean = 0.3;
constexpr double kNear_m = 10.0;
constexpr Eigen::Index kNear = 1;         // of the columns of range and intensity
constexpr double kLargestNear_mps = 0.1;  // five of the largest scale of these: more is no error, but creeps near by

// The velocity-like part of an error is about so much larger than the scale of the part that can be seen.
constexpr double kVelocityScale = 1.5;
// And where a sensor sees little of its view, a part that cannot be seen may be as large as that of sensors in use.
constexpr double kHiddenVelocity_mps = 0.4;
constexpr double kStartTau = 0.05;
constexpr double kStartVelocityTau = 0.1;
constexpr double kMinTau = 2e-4;
constexpr double kMaxTau = 0.3;
constexpr double kMaxRangeTau = 0.02;  // m/s; what creeps near by is soon taken for an error of short ranges
constexpr double kPriorTau = 0.001;    // counts like one column that was seen
constexpr double kConstantScale = 0.005;

/// exp(-|i - j| / length)
Eigen::MatrixXd exponential_kernel(std::size_t size, double length) {
  const auto n = static_cast<Eigen::Index>(size);
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      K(i, j) = std::exp(-static_cast<double>(std::abs(i - j)) / length);
    }
  }
  return K;
}

Eigen::MatrixXd identity(std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  return Eigen::MatrixXd::Identity(n, n);
}

Eigen::MatrixXd kronecker(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd K(a.rows() * b.rows(), a.cols() * b.cols());
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    for (Eigen::Index j = 0; j < a.cols(); ++j) {
      K.block(i * b.rows(), j * b.cols(), b.rows(), b.cols()) = a(i, j) * b;
    }
  }
  return K;
}

double azimuth_of(const DopplerCell& cell) { return std::atan2(cell.u.y(), cell.u.x()); }
double elevation_of(const DopplerCell& cell) { return std::asin(std::clamp(cell.u.z() / cell.u.norm(), -1.0, 1.0)); }

/// A place between nodes 0 .. count - 1: the node before and the share of the next.
std::pair<std::size_t, double> between_nodes(double share, std::size_t count) {
  const double x = std::clamp(share, 0.0, 1.0) * static_cast<double>(count - 1);
  const auto i = std::min(count - 2, static_cast<std::size_t>(x));
  return {i, x - static_cast<double>(i)};
}

/// Of each line; one that shows nothing lies where the one before does.
/// Of each line, where its cells are; of lines without any, where their numbers put them among the others.
std::vector<double> mean_elevations(const std::vector<DopplerCell>& cells, std::size_t lines) {
  std::vector<double> elevations(lines, 0.0);
  std::vector<double> counts(lines, 0.0);
  for (const DopplerCell& cell : cells) {
    elevations[cell.line] += elevation_of(cell);
    counts[cell.line] += 1.0;
  }
  std::vector<std::size_t> seen;
  for (std::size_t line = 0; line < lines; ++line) {
    if (counts[line] > 0.0) {
      elevations[line] /= counts[line];
      seen.push_back(line);
    }
  }
  if (seen.size() < 2) {
    return elevations;
  }
  for (std::size_t line = 0; line < lines; ++line) {
    if (counts[line] > 0.0) {
      continue;
    }
    const auto next = std::ranges::upper_bound(seen, line);
    const bool is_between = next != seen.begin() && next != seen.end();
    const std::size_t a = is_between ? *std::prev(next) : seen.front();
    const std::size_t b = is_between ? *next : seen.back();
    const double share = (static_cast<double>(line) - static_cast<double>(a)) / static_cast<double>(b - a);
    elevations[line] = elevations[a] + share * (elevations[b] - elevations[a]);
  }
  return elevations;
}

}  // namespace

std::size_t DopplerErrorField::add_group(std::string_view name, Eigen::MatrixXd K, double tau, bool is_learned) {
  Group group{name, size_, std::move(K), {}, {}, tau, is_learned, kMaxTau};
  group.inverse = group.K.inverse();
  group.inverse_root = group.inverse.llt().matrixL();
  size_ += group.size();
  groups_.push_back(std::move(group));
  return groups_.back().begin;
}

FieldShape DopplerErrorField::shape_of(const std::vector<DopplerCell>& cells, std::size_t faces) {
  FieldShape shape;
  shape.faces = faces;
  std::size_t sensors = 1;
  std::size_t lines = 0;
  double intensity_squares = 0.0;
  for (const DopplerCell& cell : cells) {
    sensors = std::max<std::size_t>(sensors, cell.sensor + 1U);
    lines = std::max<std::size_t>(lines, cell.line + 1U);
    shape.intensity_mean += cell.intensity / static_cast<double>(cells.size());
    intensity_squares += cell.intensity * cell.intensity / static_cast<double>(cells.size());
  }
  const double spread = std::sqrt(std::max(0.0, intensity_squares - shape.intensity_mean * shape.intensity_mean));
  shape.intensity_scale = spread > 0.0 ? 1.0 / spread : 0.0;
  if (sensors == 1 && lines <= kMaxFieldLines) {
    shape.line_elevations_rad = mean_elevations(cells, lines);
  }
  for (std::size_t s = 0; s < sensors; ++s) {
    double azimuth_low = 4.0, azimuth_high = -4.0, elevation_low = 2.0, elevation_high = -2.0;
    for (const DopplerCell& cell : cells) {
      if (cell.sensor == s) {
        azimuth_low = std::min(azimuth_low, azimuth_of(cell));
        azimuth_high = std::max(azimuth_high, azimuth_of(cell));
        elevation_low = std::min(elevation_low, elevation_of(cell));
        elevation_high = std::max(elevation_high, elevation_of(cell));
      }
    }
    shape.views.push_back({azimuth_low - kMargin_rad, std::max(0.1, azimuth_high - azimuth_low + 2.0 * kMargin_rad),
                           elevation_low - kMargin_rad,
                           std::max(0.05, elevation_high - elevation_low + 2.0 * kMargin_rad)});
  }
  return shape;
}

DopplerErrorField::DopplerErrorField(const FieldShape& shape) : shape_(shape) {
  const bool is_rig = shape.views.size() > 1;
  azimuths_ = is_rig ? kRigAzimuths : kAzimuths;
  for (const FieldShape::View& view : shape.views) {
    SensorColumns c;
    const auto count = static_cast<double>(azimuths_);
    c.azimuth = add_group("azimuth", exponential_kernel(azimuths_, kCorrelation_rad * count / view.azimuth_span),
                          kStartTau, true);
    if (!is_rig) {
      c.cross = add_group("cross",
                          kronecker(exponential_kernel(kCrossAzimuths, 3.0), exponential_kernel(kCrossElevations, 2.0)),
                          kStartTau, true);
      c.line = shape.lines() > 0 ? add_group("line", identity(shape.lines()), kStartTau, true) : 0;
      c.face = shape.faces > 1 ? add_group("face", identity(shape.faces), kStartTau, true)
                               : add_group("constant", identity(1), kStartTau, true);
      if (shape.faces <= 1) {
        groups_.back().tau_prior = VariancePrior{.scale = kConstantScale, .min_sigma = kMinTau, .max_sigma = 1.0};
      }
    }
    c.range = add_group("range and intensity", identity(3), kStartTau, true);
    groups_.back().max_tau = kMaxRangeTau;
    c.velocity = add_group("velocity", identity(3), kStartVelocityTau, false);
    sensors_.push_back(c);
  }
}

FieldColumns DopplerErrorField::columns(const DopplerCell& cell) const {
  FieldColumns result = shared_columns(cell);
  add_own_columns(cell, result);
  return result;
}

void DopplerErrorField::columns(const std::vector<DopplerCell>& cells, const Workers& workers,
                                std::vector<FieldColumns>& result) const {
  result.resize(cells.size());
  workers.for_each(cells.size(), kFieldBlock, [&](std::size_t k) { result[k] = columns(cells[k]); });
}

FieldColumns DopplerErrorField::shared_columns(const DopplerCell& cell) const {
  FieldColumns result;
  const std::size_t sensor = std::min<std::size_t>(cell.sensor, sensors_.size() - 1);
  const SensorColumns& c = sensors_[sensor];
  const FieldShape::View& view = shape_.views[sensor];
  const double azimuth = (azimuth_of(cell) - view.azimuth_first) / view.azimuth_span;
  const double bin = std::clamp(azimuth, 0.0, 1.0) * static_cast<double>(azimuths_);
  result.add(c.azimuth + std::min(azimuths_ - 1, static_cast<std::size_t>(bin)), 1.0);
  if (sensors_.size() == 1) {
    const auto [i, a] = between_nodes(azimuth, kCrossAzimuths);
    const auto [j, e] =
        between_nodes((elevation_of(cell) - view.elevation_first) / view.elevation_span, kCrossElevations);
    const std::size_t at = c.cross + i * kCrossElevations + j;
    result.add(at, (1.0 - a) * (1.0 - e));
    result.add(at + 1, (1.0 - a) * e);
    result.add(at + kCrossElevations, a * (1.0 - e));
    result.add(at + kCrossElevations + 1, a * e);
    add_channel_columns(cell, result);
  }
  return result;
}

void DopplerErrorField::add_channel_columns(const DopplerCell& cell, FieldColumns& columns) const {
  const SensorColumns& c = sensors_.front();
  if (shape_.lines() > 0) {
    columns.add(c.line + std::min<std::size_t>(cell.line, shape_.lines() - 1), 1.0);
  }
  columns.add(c.face + std::min<std::size_t>(cell.face, shape_.faces - 1), 1.0);
}

double DopplerErrorField::channel_error(const DopplerCell& cell, const Eigen::VectorXd& theta) const {
  FieldColumns columns;
  if (sensors_.size() == 1) {
    add_channel_columns(cell, columns);
  }
  return columns.dot(theta);
}

void DopplerErrorField::add_own_columns(const DopplerCell& cell, FieldColumns& columns) const {
  const SensorColumns& c = sensors_[std::min<std::size_t>(cell.sensor, sensors_.size() - 1)];
  const Eigen::Vector3d own = by_range_and_intensity(cell.range_m, cell.intensity);
  for (Eigen::Index k = 0; k < 3; ++k) {
    columns.add(c.range + static_cast<std::size_t>(k), own[k]);
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    columns.add(c.velocity + static_cast<std::size_t>(axis), -cell.u[axis]);
  }
}

Eigen::Vector3d DopplerErrorField::by_range_and_intensity(double range_m, double intensity) const {
  return {range_m / kRangeScale_m - kRangeMean, std::exp(-range_m / kNear_m),
          std::clamp(shape_.intensity_scale * (intensity - shape_.intensity_mean), -3.0, 3.0)};
}

double DopplerErrorField::own_error(std::size_t sensor, const Eigen::Vector3d& u, double range_m, double intensity,
                                    const Eigen::VectorXd& theta) const {
  const SensorColumns& c = sensors_[std::min(sensor, sensors_.size() - 1)];
  Eigen::Vector3d by_own = theta.segment<3>(static_cast<Eigen::Index>(c.range));
  by_own[kNear] = std::clamp(by_own[kNear], -kLargestNear_mps, kLargestNear_mps);
  return by_range_and_intensity(range_m, intensity).dot(by_own) -
         u.dot(theta.segment<3>(static_cast<Eigen::Index>(c.velocity)));
}

void DopplerErrorField::add_prior_information(Eigen::Ref<Eigen::MatrixXd> H) const {
  for (const Group& group : groups_) {
    const auto begin = static_cast<Eigen::Index>(group.begin);
    const Eigen::Index n = group.K.rows();
    H.block(begin, begin, n, n) += group.inverse / (group.tau * group.tau);
  }
}

void DopplerErrorField::add_prior_gradient(const Eigen::VectorXd& theta, Eigen::Ref<Eigen::VectorXd> g) const {
  for (const Group& group : groups_) {
    const auto begin = static_cast<Eigen::Index>(group.begin);
    const Eigen::Index n = group.K.rows();
    g.segment(begin, n) += (group.inverse * theta.segment(begin, n)) / (group.tau * group.tau);
  }
}

void DopplerErrorField::learn_scales(const Eigen::VectorXd& theta, const Eigen::MatrixXd& covariance_root,
                                     std::span<const double> hidden_azimuths) {
  double largest = 0.0;
  for (Group& group : groups_) {
    if (!group.is_learned) {
      continue;
    }
    const auto begin = static_cast<Eigen::Index>(group.begin);
    const Eigen::Index n = group.K.rows();
    const auto part = theta.segment(begin, n);
    if (group.tau_prior) {
      group.tau = std::sqrt(posterior_variance(
          *group.tau_prior, {part[0], covariance_root.row(begin).squaredNorm(), group.tau * group.tau}));
      continue;
    }
    const double squares = part.dot(group.inverse * part);
    // tr(K^-1 M M^T) = |root^T M|^2 with K^-1 = root root^T
    const auto M = covariance_root.middleRows(begin, n);
    const double trace = group.K.isIdentity()
                             ? M.squaredNorm()
                             : (group.inverse_root.triangularView<Eigen::Lower>().transpose() * M).squaredNorm();
    const double unknown = trace / (group.tau * group.tau);
    const double known = std::clamp(static_cast<double>(n) - unknown, 0.0, static_cast<double>(n));
    group.tau = std::clamp(std::sqrt((squares + kPriorTau * kPriorTau) / (known + 1.0)), kMinTau, group.max_tau);
    if (group.name == "azimuth" || group.name == "cross") {
      largest = std::max(largest, group.tau);
    }
  }
  for (std::size_t sensor = 0; sensor < sensors_.size(); ++sensor) {
    const double hidden = sensor < hidden_azimuths.size() ? hidden_azimuths[sensor] : 0.0;
    const auto velocity = std::ranges::find(groups_, sensors_[sensor].velocity, &Group::begin);
    velocity->tau = std::hypot(kVelocityScale * largest, kHiddenVelocity_mps * hidden);
  }
}

}  // namespace dynamic_icp::window
