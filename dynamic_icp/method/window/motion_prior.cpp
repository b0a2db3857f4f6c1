// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/motion_prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/state_archive.hpp"

namespace dynamic_icp::window {
namespace {

// Wheels of road vehicles hop at 8 to 15 Hz.
constexpr double kFrequency_hz = 11.0;
constexpr double kBandwidth_hz = 6.0;

// A turn that nothing measures would go on to any speed if its acceleration did not fade.
constexpr double kAcceleration_s = 2.0;

// What may be learned. The springs of a body that leans alone make 1 rad/s^3. Who drives changes an acceleration by
// 0.6 m/s^2 in a second, as often up as down: 5 m/s^3 in each knot interval. With less, one that went on evenly for
// long is believed to go on for ever. Without a resonator all that shakes is jerk: wheels hop with 300.
constexpr double kPriorJerks = 1.0;
constexpr double kMinJerk_rad_s3 = 1.0;
constexpr double kMinJerk_mps3 = 5.0;
constexpr double kMaxJerk_rad_s3 = 30.0;
constexpr double kMaxJerk_mps3 = 100.0;
constexpr double kMaxShaking_rad_s3 = 500.0;
constexpr double kMaxShaking_mps3 = 3000.0;
constexpr double kPriorVibrations = 1.0;
constexpr double kMinVibration_m = 1e-6;
constexpr double kMaxVibration_m = 0.01;

// A vehicle that shakes by 1 m turns by 1 / kLever rad, about half a wheel base. The axes shake alike: that counts as
// so many unknowns seen.
constexpr double kLever_m = 2.0;
constexpr double kAlike = 4.0;

// MacKay's fixed point needs something to be known of an unknown.
constexpr double kMinKnown = 0.02;

// A weighted sum of blocks of six unknowns, and its value.
struct Row {
  std::array<Eigen::Index, 8> at{};
  std::array<double, 8> weight{};
  std::size_t size = 0;
  Vector6d value = Vector6d::Zero();

  void add(Eigen::Index block, double w, const Vector6d& unknowns) {
    at[size] = block;
    weight[size++] = w;
    value += w * unknowns;
  }
};

Row jerk_row(const SplineTrajectory& trajectory, std::size_t k, const Layout& layout) {
  const std::array<double, 4> w = jerk_weights(trajectory.knot_spacing());
  Row row;
  for (std::size_t i = 0; i < w.size(); ++i) {
    row.add(layout.coefficient(k + i), w[i], trajectory.coefficients()[k + i]);
    if (layout.vibrates) {
      row.add(layout.vibration(k + i), -w[i], trajectory.vibration()[k + i]);
    }
  }
  return row;
}

Row vibration_row(const SplineTrajectory& trajectory, std::size_t k, const std::array<double, 3>& w,
                  const Layout& layout) {
  Row row;
  for (std::size_t i = 0; i < std::min(w.size(), k + 1); ++i) {
    row.add(layout.vibration(k - i), w[i], trajectory.vibration()[k - i]);
  }
  return row;
}

void add_row(const Row& row, const Vector6d& information, Eigen::MatrixXd& H, Eigen::VectorXd& g) {
  const Vector6d gradient = information.cwiseProduct(row.value);
  for (std::size_t i = 0; i < row.size; ++i) {
    g.segment<6>(row.at[i]) += row.weight[i] * gradient;
    for (std::size_t j = 0; j < row.size; ++j) {
      H.block<6, 6>(row.at[i], row.at[j]).diagonal() += (row.weight[i] * row.weight[j]) * information;
    }
  }
}

/// The rows of a scan, six sums each, and the variances of these by the factor of the unknowns from `first` on.
class RowVariances {
 public:
  RowVariances(const std::vector<Row>& rows, Eigen::Index first, const RestFactor& factor) {
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(factor.size(), 6 * static_cast<Eigen::Index>(rows.size()));
    for (std::size_t k = 0; k < rows.size(); ++k) {
      for (std::size_t i = 0; i < rows[k].size; ++i) {
        sums.block<6, 6>(rows[k].at[i] - first, 6 * static_cast<Eigen::Index>(k)).diagonal().array() +=
            rows[k].weight[i];
      }
    }
    variances_ = factor.covariance_root(std::move(sums)).colwise().squaredNorm();
  }

  [[nodiscard]] Vector6d of(std::size_t row) const { return variances_.segment<6>(6 * static_cast<Eigen::Index>(row)); }

 private:
  Eigen::VectorXd variances_;
};

Vector6d values(const std::array<LearnedVariance, 6>& variances) {
  Vector6d result;
  for (std::size_t axis = 0; axis < variances.size(); ++axis) {
    result[static_cast<Eigen::Index>(axis)] = variances[axis].value();
  }
  return result;
}

// Evidence of the rows of a scan.
struct Evidence {
  Vector6d squares = Vector6d::Zero();
  Vector6d known = Vector6d::Zero();

  void add(const Row& row, const Vector6d& prior, const Vector6d& posterior) {
    squares += row.value.cwiseAbs2();
    known += (Vector6d::Ones() - posterior.cwiseQuotient(prior)).cwiseMax(kMinKnown);
  }
};

}  // namespace

std::array<double, 4> jerk_weights(double knot_spacing_s) {
  const double kept = std::exp(-knot_spacing_s / kAcceleration_s);
  const double scale = 1.0 / (knot_spacing_s * knot_spacing_s * knot_spacing_s);
  return {-kept * scale, (1.0 + 2.0 * kept) * scale, -(2.0 + kept) * scale, scale};
}

MotionPrior::MotionPrior(const WindowConfig& config) {
  const double radius = std::exp(-std::numbers::pi * kBandwidth_hz * config.knot_spacing_s);
  const double angle = 2.0 * std::numbers::pi * kFrequency_hz * config.knot_spacing_s;
  const double a1 = 2.0 * radius * std::cos(angle);
  const double a2 = -radius * radius;
  resonator_ = {a1, a2};
  gain_ = (1.0 - a2) / ((1.0 + a2) * ((1.0 - a2) * (1.0 - a2) - a1 * a1));
  const double start = config.start_vibration_m / std::sqrt(gain_);
  const double smallest = kMinVibration_m / std::sqrt(gain_);
  const double largest = kMaxVibration_m / std::sqrt(gain_);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const bool turns = axis < 3;
    const double max_rad_s3 = config.learn_vibration ? kMaxJerk_rad_s3 : kMaxShaking_rad_s3;
    const double max_mps3 = config.learn_vibration ? kMaxJerk_mps3 : kMaxShaking_mps3;
    jerk_[axis] = turns ? LearnedVariance({config.start_jerk_rad_s3, kPriorJerks, kMinJerk_rad_s3, max_rad_s3})
                        : LearnedVariance({config.start_jerk_mps3, kPriorJerks, kMinJerk_mps3, max_mps3});
    const double scale = turns ? 1.0 / kLever_m : 1.0;
    vibration_[axis] = LearnedVariance({scale * start, kPriorVibrations, scale * smallest, scale * largest});
  }
}

void MotionPrior::add(const SplineTrajectory& trajectory, std::size_t first_new, const Layout& layout,
                      Eigen::MatrixXd& H, Eigen::VectorXd& g) const {
  const Vector6d jerk_information = jerk_variance().cwiseInverse();
  for (std::size_t k = first_new; k + 3 < trajectory.coefficients().size(); ++k) {
    add_row(jerk_row(trajectory, k, layout), jerk_information, H, g);
  }
  if (!layout.vibrates) {
    return;
  }
  const Vector6d driven = values(vibration_).cwiseInverse();
  const auto [a1, a2] = resonator_;
  for (std::size_t k = first_new == 0 ? 2 : first_new + 3; k < trajectory.coefficients().size(); ++k) {
    add_row(vibration_row(trajectory, k, {1.0, -a1, -a2}, layout), driven, H, g);
  }
  if (first_new == 0) {
    // Stationary: v_0 has the variance of v, and v_1 given v_0 what their correlation leaves.
    const double correlation = a1 / (1.0 - a2);
    add_row(vibration_row(trajectory, 0, {1.0, 0.0, 0.0}, layout), driven / gain_, H, g);
    add_row(vibration_row(trajectory, 1, {1.0, -correlation, 0.0}, layout),
            driven / (gain_ * (1.0 - correlation * correlation)), H, g);
  }
}

void MotionPrior::learn(const SplineTrajectory& trajectory, std::size_t begin, std::size_t end, const Layout& layout,
                        const RestFactor& factor) {
  Evidence jerks;
  Evidence vibrations;
  const Vector6d q = jerk_variance();
  const Vector6d r = values(vibration_);
  const auto [a1, a2] = resonator_;
  std::vector<Row> rows;
  for (std::size_t k = begin; k < end; ++k) {
    rows.push_back(jerk_row(trajectory, k, layout));
  }
  for (std::size_t k = begin; k < end && layout.vibrates; ++k) {
    rows.push_back(vibration_row(trajectory, k + 3, {1.0, -a1, -a2}, layout));
  }
  const RowVariances variances(rows, layout.field, factor);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const bool is_jerk = k < end - begin;
    (is_jerk ? jerks : vibrations).add(rows[k], is_jerk ? q : r, variances.of(k));
  }
  double squares = 0.0;
  double counts = 0.0;
  for (std::size_t axis = 3; axis < 6; ++axis) {
    squares += vibration_[axis].counts() * vibration_[axis].value();
    counts += vibration_[axis].counts();
  }
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    jerk_[axis].update(jerks.squares[at], jerks.known[at]);
    if (layout.vibrates) {
      vibration_[axis].follow(squares / counts * (axis < 3 ? 1.0 / (kLever_m * kLever_m) : 1.0), kAlike);
      vibration_[axis].update(vibrations.squares[at], vibrations.known[at]);
    }
  }
}

void MotionPrior::keep() {
  for (std::size_t axis = 0; axis < 6; ++axis) {
    jerk_[axis].keep();
    vibration_[axis].keep();
  }
}

Vector6d MotionPrior::jerk_variance() const { return values(jerk_); }

Vector6d MotionPrior::vibration_variance() const { return gain_ * values(vibration_); }

void MotionPrior::state(StateArchive& archive) { archive(jerk_, vibration_); }

}  // namespace dynamic_icp::window
