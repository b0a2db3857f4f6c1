// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/window/window_estimator.hpp"

// What the estimate of a scan is used for.
namespace dynamic_icp::window {
namespace {

constexpr std::size_t kPlacingBlock = 512;

// Of a scan, in which what is unknown of the pose counts as the same.
constexpr std::size_t kSweepParts = 4;

// Sensors in use err by no more than this with direction and range. More was learned of a vehicle that set off slowly.
constexpr double kLargestError_mps = 0.3;

/// One point as a cell of its own, for what it shares with others.
DopplerCell point_of(const Scan& scan, std::size_t i) {
  const Channels& channels = scan.channels();
  DopplerCell point;
  point.u = scan.directions()[i];
  point.line = channels.line.empty() ? DopplerCells::line_of(point.u) : channels.line[i];
  point.face = channels.face.empty() ? std::uint8_t{0} : channels.face[i];
  point.sensor = channels.sensor.empty() ? std::uint8_t{0} : channels.sensor[i];
  return point;
}

}  // namespace

std::vector<Eigen::Vector3d> WindowEstimator::add_to_map(const WindowScan& scan, mapping::PlaneMap& map,
                                                         const Workers& workers) {
  const Scan& points = *scan.static_points;
  std::vector<Eigen::Vector3d> in_map(points.size());
  std::vector<double> phases(points.size(), 0.0);
  std::vector<Eigen::Vector3d> at_stamp(points.size());
  const double stamp_s = scan.stamp_s;
  const Eigen::Isometry3d T_map_stamp = trajectory_.pose(stamp_s);
  const Eigen::Isometry3d T_stamp_reference = T_map_stamp.inverse() * trajectory_.reference();
  const double duration_s = scan.end_s - scan.begin_s;
  const double slice_s = config_.knot_spacing_s / kSlices;
  std::vector<TrajectoryPoint> slices;
  for (double tau = scan.begin_s; tau <= scan.end_s + slice_s; tau += slice_s) {
    slices.push_back(trajectory_.at(stamp_s + tau));
  }
  workers.for_each(points.size(), kPlacingBlock, [&](std::size_t i) {
    const double tau = points.has_times() ? points.times()[i] : 0.0;
    const auto slice = std::min(slices.size() - 1, static_cast<std::size_t>((tau - scan.begin_s) / slice_s + 0.5));
    const double step_s = tau - scan.begin_s - static_cast<double>(slice) * slice_s;
    at_stamp[i] = T_stamp_reference * slices[slice].place(points.points()[i], step_s);
    in_map[i] = T_map_stamp * at_stamp[i];
    phases[i] = duration_s > 0.0 ? std::clamp((tau - scan.begin_s) / duration_s, 0.0, 1.0) : 0.0;
  });
  map.add(in_map, T_map_stamp.translation(), workers, phases);
  return at_stamp;
}

/// Of six sums of the unknowns but theta.
Matrix6d WindowEstimator::covariance_of(const Eigen::MatrixXd& rows) const {
  const Eigen::MatrixXd root = rest_factor_.covariance_root(rows.transpose());
  const Matrix6d covariance = root.transpose() * root;
  return 0.5 * (covariance + covariance.transpose());
}

/// Of the displacement of what is seen at some times of the scan at hand against the map of that phase of the sweep.
std::vector<Matrix6d> WindowEstimator::displacement_covariances(const std::vector<double>& times) const {
  if (!elimination_.is_solvable() || !rest_factor_.is_solvable()) {
    return {};
  }
  const Layout at = rest_layout();
  const std::size_t parts = std::min(times.size(), kSweepParts);
  const auto count = static_cast<Eigen::Index>(parts);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6 * count, rest_factor_.size());
  const double duration_s = end_s_ - begin_s_;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double time_s = times[(2 * static_cast<std::size_t>(k) + 1) * times.size() / (2 * parts)];
    auto of_time = rows.middleRows<6>(6 * k);
    of_time.middleCols(at.coefficient(0), 6 * at.coefficients) = displacement_rows(time_s, at);
    const double share = duration_s > 0.0 ? std::clamp((time_s - stamp_s() - begin_s_) / duration_s, 0.0, 1.0) : 0.0;
    const double phase = share * static_cast<double>(Layout::kMapNodes - 1);
    const auto node = std::min<std::size_t>(Layout::kMapNodes - 2, static_cast<std::size_t>(phase));
    const double beyond = phase - static_cast<double>(node);
    of_time.middleCols<6>(at.map_node(node)).diagonal().setConstant(beyond - 1.0);
    of_time.middleCols<6>(at.map_node(node + 1)).diagonal().setConstant(-beyond);
  }
  const Eigen::MatrixXd root = rest_factor_.covariance_root(rows.transpose());
  std::vector<Matrix6d> covariances(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto of_time = root.middleCols<6>(6 * static_cast<Eigen::Index>(i * parts / times.size()));
    covariances[i] = of_time.transpose() * of_time;
  }
  return covariances;
}

void WindowEstimator::motion_between(double source_s, WindowMotion& motion) const {
  const TrajectoryPoint a = trajectory_.at(source_s);
  const TrajectoryPoint b = trajectory_.at(stamp_s());
  const Eigen::Matrix3d R = b.R.transpose() * a.R;
  motion.T_target_source.linear() = R;
  motion.T_target_source.translation() = b.R.transpose() * (a.p - b.p);
  // omega = R alpha - beta and rho = R_b^T (dp_a - dp_b) - beta x t - omega x t, with alpha, beta = J dphi.
  const Eigen::Vector3d t = motion.T_target_source.translation();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, rest_factor_.size());
  for (std::size_t k = 0; k < 4; ++k) {
    const auto of_a = Layout::kBefore + static_cast<Eigen::Index>(6 * (a.first + k));
    const auto of_b = Layout::kBefore + static_cast<Eigen::Index>(6 * (b.first + k));
    const Eigen::Matrix3d alpha = a.weight[k] * R * a.J;
    const Eigen::Matrix3d beta = b.weight[k] * b.J;
    rows.block<3, 3>(0, of_a) += alpha;
    rows.block<3, 3>(0, of_b) -= beta;
    rows.block<3, 3>(3, of_a) += skew(t) * alpha;
    rows.block<3, 3>(3, of_a + 3) += a.weight[k] * b.R.transpose();
    rows.block<3, 3>(3, of_b + 3) -= b.weight[k] * b.R.transpose();
  }
  rows.block<3, 1>(0, Layout::kMapError) = R * a.omega;
  rows.block<3, 1>(3, Layout::kMapError) = skew(t) * (R * a.omega) + R * a.velocity;
  rows.block<3, 1>(0, Layout::kMapError + 1) = -b.omega;
  rows.block<3, 1>(3, Layout::kMapError + 1) = -b.velocity;
  motion.covariance = covariance_of(rows);
}

/// How the sensor moves at its stamp: v = R^T dp/dt and omega = J dphi/dt, with dv = R^T d(dp/dt) + [v]x J dphi and
/// domega = J d(dphi/dt) + 1/2 [omega]x dphi.
void WindowEstimator::find_twist() {
  const TrajectoryPoint at = trajectory_.at(stamp_s());
  twist_.angular = at.omega;
  twist_.linear = at.velocity;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(6, rest_factor_.size());
  for (std::size_t k = 0; k < 4; ++k) {
    const auto column = Layout::kBefore + static_cast<Eigen::Index>(6 * (at.first + k));
    rows.block<3, 3>(0, column) = at.slope[k] * at.J + 0.5 * at.weight[k] * skew(at.omega);
    rows.block<3, 3>(3, column) = at.weight[k] * skew(at.velocity) * at.J;
    rows.block<3, 3>(3, column + 3) = at.slope[k] * at.R.transpose();
  }
  twist_.covariance = covariance_of(rows);
}

std::optional<double> WindowEstimator::point_noise() const {
  const std::vector<double>& variance = cells_.noise().variance;
  return variance.empty() ? std::nullopt : std::optional(std::sqrt(median(variance)));
}

FieldColumns WindowEstimator::columns_of(const Scan& scan, std::size_t row) const {
  DopplerCell cell = point_of(scan, row);
  cell.range_m = cells_.range_m(row);
  cell.intensity = scan.channels().intensity.empty() ? 0.0 : static_cast<double>(scan.channels().intensity[row]);
  return field_->columns(cell);
}

void WindowEstimator::field_errors(const Scan& scan, const Workers& workers, FieldErrors& errors) const {
  errors.learned.assign(scan.size(), 0.0);
  errors.credible.assign(scan.size(), 0.0);
  if (!field_ || !config_.learn_field) {
    return;
  }
  const Channels& channels = scan.channels();
  // Of the sensors of a rig the error by azimuth holds the constant one, which may be large.
  const double largest = scan.is_of_rig() ? std::numeric_limits<double>::infinity() : kLargestError_mps;
  workers.for_each(cells_.count(), kCellBlock, [&](std::size_t cell) {
    const DopplerCell first = point_of(scan, cells_.points(cell).front());
    const double by_channel = field_->channel_error(first, theta_);
    const double shared = field_->shared_columns(first).dot(theta_);
    for (const std::uint32_t i : cells_.points(cell)) {
      const std::size_t sensor = channels.sensor.empty() ? 0 : channels.sensor[i];
      const double intensity = channels.intensity.empty() ? 0.0 : static_cast<double>(channels.intensity[i]);
      errors.learned[i] =
          shared + field_->own_error(sensor, scan.directions()[i], cells_.range_m(i), intensity, theta_);
      errors.credible[i] = by_channel + std::clamp(errors.learned[i] - by_channel, -largest, largest);
    }
  });
}

/// During the scan at hand.
SampledMotion WindowEstimator::sampled_motion() const {
  return {trajectory_, stamp_s() + begin_s_, stamp_s() + end_s_};
}

void WindowEstimator::static_doppler(const Scan& scan, const Workers& workers, std::vector<double>& predicted) const {
  const SampledMotion motion = sampled_motion();
  predicted.resize(scan.size());
  const bool is_of_rig = scan.is_of_rig();
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    const double time_s = stamp_s() + (scan.has_times() ? scan.times()[i] : 0.0);
    Eigen::Vector3d v = motion.velocity(time_s);
    if (is_of_rig) {
      v += motion.omega(time_s).cross(scan.mountings()[scan.channels().sensor[i]].translation());
    }
    predicted[i] = -scan.directions()[i].dot(v);
  });
}

}  // namespace dynamic_icp::window
