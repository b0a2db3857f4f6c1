// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/detection.hpp"
#include "dynamic_icp/method/tracking/motion_filter.hpp"
#include "dynamic_icp/method/tracking/oriented_box.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp::tracking {

/// What is seen of a body along one axis of its box.
struct AxisView {
  Interval seen;         ///< relative to the centre of the box
  bool low_end = false;  ///< whether the body truly ends where it seems to
  bool high_end = false;
};

/// One hypothesis about a moving body: a filter for the motion of the centre of its box, and the box.
///
/// The box is anchored at the ends that are seen. Ends that are hidden, by the body itself, by something before it or
/// by the edge of the field of view, only say how large it is at least. When the box grows the true ends stay where
/// they are and the centre moves, without a trace in the velocity: parts that come into view are no motion.
class BoxFilter {
 public:
  /// From a first detection with at least one point, at its mean time. `yaw`: the direction in which, or against which,
  /// the body is taken to move, as vehicles move along their sides. Without it nothing is assumed.
  BoxFilter(const Detection& detection, std::optional<double> yaw_rad, const TrackConfig& config);

  /// Moves the state on by `dt_s` seconds, which may be negative.
  void predict(double dt_s, const TrackConfig& config);

  /// Takes in another detection; the state must be that of its mean time.
  void correct(const Detection& detection, const TrackConfig& config);

  [[nodiscard]] const MotionFilter& motion() const { return motion_; }
  [[nodiscard]] OrientedBox box() const;  ///< world

  /// How well the hypothesis has explained what was seen; comparable between hypotheses about the same detections.
  [[nodiscard]] double log_likelihood() const { return log_likelihood_; }

  /// Deviation of the direction of the velocity, rad; pi for what stands.
  [[nodiscard]] double direction_sigma() const;

  /// Spread of the last detection's radial velocities about those of a rigid body, m/s.
  [[nodiscard]] double spread_mps() const { return spread_mps_; }

  /// Root mean square of the radial velocities of a rigid body that explains them best, m/s.
  [[nodiscard]] double signal_mps() const { return signal_mps_; }

 private:
  void correct_doppler(const Detection& detection, const TrackConfig& config);
  void correct_yaw(const Detection& detection, const TrackConfig& config);
  void follow_direction();
  void make_box(const Detection& detection, const TrackConfig& config);
  void correct_box(const Detection& detection, const TrackConfig& config);
  void evaluate_width(const TrackConfig& config);
  void correct_axis(int axis, const Detection& detection, double sigma);
  [[nodiscard]] AxisView look_along(int axis, const Detection& detection) const;
  [[nodiscard]] bool is_true_end(const Eigen::Vector3d& end, const Eigen::Vector3d& outward,
                                 const Detection& detection) const;

  MotionFilter motion_;
  bool moves_along_sides_;
  double yaw_ = 0.0;
  Eigen::Vector3d size_ = Eigen::Vector3d::Zero();
  double log_likelihood_ = 0.0;
  double spread_mps_ = 0.0;
  double signal_mps_ = 0.0;
  double box_sigma_rad_ = 0.0;  ///< of the direction when the box was last made anew
};

}  // namespace dynamic_icp::tracking
