// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/body_filter.hpp"
#include "dynamic_icp/method/tracking/box_view.hpp"
#include "dynamic_icp/method/tracking/detection.hpp"
#include "dynamic_icp/method/tracking/likely_extent.hpp"
#include "dynamic_icp/method/tracking/motion_models.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// A body as one hypothesis has it, world.
struct BoxEstimate {
  OrientedBox box;
  Eigen::Matrix3d centre_covariance = Eigen::Matrix3d::Zero();    ///< m^2
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();             ///< m/s, of the centre
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Zero();  ///< (m/s)^2
  std::array<FaceView, kFaces.size()> faces{};                    ///< by Face
};

/// What was known of a body before a hypothesis begins.
struct BoxHistory {
  double log_likelihood = 0.0;  ///< of what was seen
  bool was_vehicle = false;     ///< no person moves as it did
};

/// Standard deviation of what is anywhere in a gap, as a share.
constexpr double kUniform = 0.29;

/// Standard deviation of where a face is that was not seen.
constexpr double kUnknownFace_m = 10.0;

/// Sides shorter than this have no direction, m.
constexpr double kShortestSide_m = 1.0;

/// Whether what is seen of a body lies along the line of sight and is narrower than a vehicle: nearer things cut it out
/// of a roof, or of the ground, and its direction is that of the sight.
bool is_strip_along_sight(std::span<const Eigen::Vector3d> points, const Eigen::Matrix3d& axes,
                          const Eigen::Vector3d& sensor);

/// Standard deviation of what is seen of a face at a place, m.
double face_sigma(const Eigen::Vector3d& where, const Detection& detection, const TrackConfig& config);

/// One hypothesis about a moving body: an upright box that moves where it points, or one that moves without turning,
/// anywhere.
///
/// Faces that are seen are measured. Those that something hides, the body itself, a nearer thing or the edge of the
/// field of view, only lie no nearer than the farthest point seen; how far beyond says the size of other road users of
/// that width, height or length (size_prior).
class BoxFilter {
 public:
  /// From a first detection with at least one point, at its mean time. `yaw`: the direction in which, or against which,
  /// the body is taken to move, as vehicles move along their sides; level axes. Without it the body has no heading.
  BoxFilter(const Detection& detection, std::optional<double> yaw_rad, const BoxHistory& history,
            const TrackConfig& config);

  /// One of which nothing is known, for its state to be read.
  static BoxFilter blank();

  /// Moves the state on by `dt_s` seconds, which may be negative.
  void predict(double dt_s, const TrackConfig& config);

  /// Takes in another detection; the state must be that of its mean time.
  void correct(const Detection& detection, const TrackConfig& config);

  /// Lets the body follow one of the models of motion.
  void suppose(MotionModel model) { constrain(model, body_); }

  /// Says that the body ends about at along . x = place_m in the direction `along` (unit, world), if it is along it.
  void end_at(const Eigen::Vector3d& along, double place_m);

  /// Says that another box is a part of the body, which reaches so far at least to the front and to the rear. What is
  /// no splinter says so, too, where an end was seen before.
  void include(const OrientedBox& part, bool is_splinter);

  /// Says how much farther it may reach than it was seen to.
  void set_room(const Room& room);

  /// Something else speaks for the hypothesis, by this logarithm of a likelihood.
  void credit(double log_likelihood) { log_likelihood_ += log_likelihood; }

  [[nodiscard]] const BodyFilter& body() const { return body_; }
  [[nodiscard]] const MotionProbabilities& motion() const { return models_.probabilities(); }
  [[nodiscard]] bool has_heading() const { return has_heading_; }
  [[nodiscard]] bool was_vehicle() const { return was_vehicle_; }
  /// `sizes`: those of other vehicles.
  [[nodiscard]] BoxEstimate estimate(const VehicleSizes& sizes = {}) const;

  /// Whether it was seen from end to end along all its axes, and is no person.
  [[nodiscard]] bool is_whole_vehicle() const;

  /// The part of the box that was seen.
  [[nodiscard]] OrientedBox seen_box() const;

  /// How well the hypothesis has explained what was seen; comparable between hypotheses about the same detections.
  [[nodiscard]] double log_likelihood() const { return log_likelihood_ + size_log_likelihood_; }

  /// The same with what speaks for the hypothesis before anything of the body is seen.
  [[nodiscard]] double log_posterior() const { return log_likelihood() + log_prior_; }
  void set_log_prior(double log_prior) { log_prior_ = log_prior; }

  /// Whether it was seen from end to end in one direction at least, is no larger than a person and was never faster,
  /// for sure: how fast it moves across the line of sight may not be known yet.
  [[nodiscard]] bool is_as_large_as_person() const;

  /// Spread of the last detection's radial velocities about those of a rigid body, m/s.
  [[nodiscard]] double spread_mps() const { return spread_mps_; }

  /// Root mean square of the radial velocities of a rigid body that explains them best, m/s.
  [[nodiscard]] double signal_mps() const { return signal_mps_; }

  void state(StateArchive& archive);

 private:
  explicit BoxFilter(const BodyFilter& body) : body_(body), has_heading_(false) {}

  void correct_doppler(const Detection& detection, const TrackConfig& config);
  void correct_heading(std::span<const Eigen::Vector3d> points, const Detection& detection, const TrackConfig& config);
  void correct_faces(std::span<const Eigen::Vector3d> points, const Detection& detection, const TrackConfig& config);
  void correct_face(Face face, const EndView& end, const Detection& detection, const TrackConfig& config);
  [[nodiscard]] double hidden_corner(Face face, const Eigen::Vector3d& at_end, const Detection& detection) const;
  void correct_middle(int axis, const Interval& seen);
  void limit_width(const TrackConfig& config);
  void limit_length(double sigma_m);
  void forget_stumps(const Detection& detection);
  [[nodiscard]] double size_log_likelihood(const TrackConfig& config) const;
  [[nodiscard]] bool is_fast_for_sure() const;
  [[nodiscard]] bool may_be_person() const;
  [[nodiscard]] bool is_known(Face face) const;
  [[nodiscard]] double reach(Face face) const;
  [[nodiscard]] bool is_whole(int axis) const;
  [[nodiscard]] double span(int axis) const;
  [[nodiscard]] double likely_width() const;
  [[nodiscard]] SeenExtent extent(int axis) const;

  BodyFilter body_;
  MotionModels models_;
  bool has_heading_;
  bool was_vehicle_ = false;                     ///< faster than any person, at any time
  bool is_part_ = false;                         ///< of a body that bends: as short as a cab
  bool top_is_cut_ = false;                      ///< by the edge of the field of view, where it was highest
  std::array<double, kFaces.size()> least_{};    ///< m from the reference: points were seen so far out
  std::array<FaceView, kFaces.size()> faces_{};  ///< by Face
  std::array<double, kFaces.size()> hidden_{};   ///< m: so much farther than its upper part a body is likely to reach
  std::array<double, 2> free_{kUnlimited_m, kUnlimited_m};  ///< m from the reference, ahead and behind: up to others
  std::array<std::optional<Interval>, 2> last_seen_{};      ///< m from the reference, along and to the left: at last
  double log_likelihood_ = 0.0;                             ///< of the motion
  double size_log_likelihood_ = 0.0;                        ///< of the sizes
  double log_prior_ = 0.0;                                  ///< of heading and speed
  double spread_mps_ = 0.0;
  double signal_mps_ = 0.0;
};

}  // namespace dynamic_icp::tracking
