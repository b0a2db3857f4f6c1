// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/tracking/box_filter.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// Two sides of a body, at right angles, of which at least one is seen.
struct BodySides {
  double yaw_rad = 0.0;   ///< level axes, of one of them
  double length_m = 0.0;  ///< of the longer one
  bool is_strip = false;  ///< along the line of sight: it may be no side
};

/// One object over time.
///
/// At first sight the Doppler leaves open how much of what is seen across the line of sight is turning, and the sides
/// leave open which of them is the front. So a track begins with several hypotheses, each with its own direction, and
/// drops those that explain the next detections worse. It begins anew when the one that remains moves sideways.
class Track {
 public:
  /// Of nothing yet: to be begun, or to be read.
  Track() { hypotheses_.reserve(kMaxHypotheses); }

  /// From a first detection with at least one point, in a scan `stamp_s` after any origin of time.
  Track(const Detection& detection, double stamp_s, const TrackConfig& config) : Track() {
    begin(detection, stamp_s, config);
  }

  /// The same in the memory of another track.
  void begin(const Detection& detection, double stamp_s, const TrackConfig& config);

  /// Moves the state to `time_s`.
  void predict(double time_s, const TrackConfig& config);

  /// Lets the body follow one of the models of motion from now on.
  void suppose(MotionModel model);

  /// Says that the body points in this direction, level axes, if any hypothesis has it so.
  void point_along(double yaw_rad);

  /// Says that the body, whose heading is along the direction (unit, world), ends in it about at along . x = place_m.
  void end_at(const Eigen::Vector3d& along, double place_m);

  /// Says that another box is a part of the body.
  void include(const OrientedBox& part, bool is_splinter);

  /// Says how much farther the body may reach than it was seen to, if its heading is sure.
  void set_room(const Room& room);

  /// Takes in another detection; the state is then that of its mean time.
  void correct(const Detection& detection, double stamp_s, const TrackConfig& config);

  /// Whether the sides of the body tell its heading, and nothing else explains it.
  [[nodiscard]] bool is_sure_of_heading() const { return has_sides_ && hypotheses_.size() == 1; }

  /// Of the best hypothesis, among those that are left.
  [[nodiscard]] double probability() const;

  /// Whether its sides show the heading, with this probability at least.
  [[nodiscard]] bool shows_heading(double least_probability) const {
    return has_sides_ && best().has_heading() && probability() >= least_probability;
  }

  [[nodiscard]] double time_s() const { return time_s_; }
  [[nodiscard]] const BoxFilter& best() const { return hypotheses_[best_]; }
  [[nodiscard]] const BodyFilter& body() const { return best().body(); }

  /// The best hypothesis; its covariances hold the disagreement of the others.
  /// `sizes`: those of other vehicles.
  [[nodiscard]] BoxEstimate estimate(const VehicleSizes& sizes = {}) const;

  void state(StateArchive& archive);

 private:
  // Without heading, with that of the motion or of other vehicles, with either direction along the sides, and with that
  // of other vehicles again.
  static constexpr std::size_t kMaxHypotheses = 5;

  void add_headings(const Detection& detection, const BoxHistory& history, const TrackConfig& config);
  void add_headings_along(const BodySides& sides, const Detection& detection, const BoxHistory& along_sides,
                          const TrackConfig& config);
  [[nodiscard]] std::optional<double> heading_of_motion() const;
  [[nodiscard]] bool has_heading() const;
  [[nodiscard]] bool moves_sideways() const;
  void ask_traffic(const Detection& detection, const TrackConfig& config);
  void evaluate(const Detection& detection, const TrackConfig& config);
  void choose_best();

  std::vector<BoxFilter> hypotheses_;
  std::size_t best_ = 0;
  double time_s_ = 0.0;
  int detections_ = 0;
  bool has_sides_ = false;  ///< long enough to show a heading, at any time
};

}  // namespace dynamic_icp::tracking
