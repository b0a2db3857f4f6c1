// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/ego_motion/support_plane.hpp"
#include "dynamic_icp/method/tracking/association.hpp"
#include "dynamic_icp/method/tracking/expectation.hpp"
#include "dynamic_icp/method/tracking/ground.hpp"
#include "dynamic_icp/method/tracking/ground_heights.hpp"
#include "dynamic_icp/method/tracking/sensor_motion.hpp"
#include "dynamic_icp/method/tracking/track_record.hpp"
#include "dynamic_icp/method/tracking/tracked_object.hpp"
#include "dynamic_icp/method/tracking/tracker_config.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::tracking {

/// Follows moving things from scan to scan.
///
/// In each scan every track predicts its box; moving points in it with the predicted radial velocity are its own. What
/// is left is grouped, and groups with enough points become new tracks. Objects that cross the line of sight have no
/// radial velocity and are no "moving" points: slow tracks look for their points among the others too.
///
/// Objects that stop remain objects for a while, and those that are hidden as long as their prediction is of use. What
/// never moved is none.
///
/// Up is the normal of the ground, and the world's z axis until one was seen. Results do not depend on the number of
/// threads.
class ObjectTracker {
 public:
  /// Throws UsageError when the configuration is out of range.
  explicit ObjectTracker(const TrackerConfig& config);

  /// Sets `is_moving` of the rows that confirmed tracks expect to be theirs in a scan that is not deskewed: what
  /// crosses the line of sight has no radial velocity, and tells itself from what stands by its past alone. `patches`:
  /// of this scan.
  void flag_expected(const Scan& scan, const ScanPatches& patches, std::span<const double> radial,
                     const SensorMotion& sensor, const Workers& workers, std::vector<std::uint8_t>& is_moving);

  /// Forgets objects and ground, after scans in which what passed for static was not. No number comes again.
  void forget();

  /// Clears `is_moving` of the rows that are too near to their sensor to be objects, in a scan that is not deskewed.
  /// `patches`: of this scan.
  void clear_carrier(const Scan& scan, const ScanPatches& patches, std::vector<std::uint8_t>& is_moving) const;

  /// All tracks at the stamp of the scan, in the order of their birth, tentative ones too: report those that are
  /// confirmed.
  ///
  /// The points of the scan are where they were measured, in the sensor frame at its stamp (deskewed); lines of sight
  /// are as measured, while it moved as `sensor` says. `radial`: for each row the velocity of the point itself along
  /// its line of sight over ground (m/s). `is_moving`: for each row nonzero where that is too much for noise.
  /// `support`: the plane that carries the scene, where it shows one. `ego_covariance`: of the velocity of the sensor,
  /// (m/s)^2, sensor frame; all velocities over ground share its error. `measured`: the patches of the scan before it
  /// was deskewed, if they are known, which saves looking at all points once more. The objects are valid until the next
  /// call. Throws std::invalid_argument when these differ in length or are not finite, and when the stamp is not later
  /// than that of the previous scan.
  std::span<const TrackedObject> update(const Scan& scan, std::span<const double> radial,
                                        std::span<const std::uint8_t> is_moving, const SensorMotion& sensor,
                                        const std::optional<ego_motion::SupportPlane>& support, const Workers& workers,
                                        const Eigen::Matrix3d& ego_covariance = Eigen::Matrix3d::Zero(),
                                        const ScanPatches* measured = nullptr);

  /// That of the last scan; nothing before the first.
  [[nodiscard]] const std::optional<Stamp>& last_stamp() const { return last_stamp_; }

  /// What is known between two scans.
  void state(StateArchive& archive);

 private:
  [[nodiscard]] std::span<TrackRecord> living();
  void keep(TrackRecord& entry);
  void find_ground(const Scan& scan, std::span<const std::uint8_t> is_moving,
                   const std::optional<ego_motion::SupportPlane>& support, const Eigen::Isometry3d& T_world_sensor);
  const ScanPatches& patches_of(const Scan& scan, const ScanPatches* measured, const Workers& workers);
  const ScanPatches& sights_of(const Scan& scan, const ScanPatches* measured, const Workers& workers);
  TrackingInput prepare(const Scan& scan, const ScanPatches* measured, std::span<const double> radial,
                        std::span<const std::uint8_t> is_moving, const SensorMotion& sensor, const Workers& workers);
  void gather_traffic(const SensorMotion& sensor);
  template <typename Choice>
  void expect(double stamp_s, const SensorMotion& sensor, const Choice& choice);
  void collect_members(const TrackingInput& input, const Workers& workers);
  void gather_static(const TrackingInput& input, const Expectation& expected, TrackRecord& entry) const;
  bool detect(const TrackingInput& input, std::span<const std::uint32_t> rows, Detection& detection) const;
  void correct(const TrackingInput& input, const Expectation& expected, TrackRecord& entry) const;
  void initiate_tracks(const TrackingInput& input, const Workers& workers);
  void begin(const TrackingInput& input, std::span<const std::uint32_t> rows, TrackRecord& entry) const;
  void divide_tracks(const TrackingInput& input);
  void divide(const TrackingInput& input, const Joint& joint, TrackRecord& body, TrackRecord& larger,
              TrackRecord& smaller);
  [[nodiscard]] TrackRecord* same_object(const TrackRecord& entry, const TrackingInput& input);
  void make_way();
  void delete_tracks(const TrackingInput& input);

  TrackerConfig config_;
  std::vector<TrackRecord> entries_;  ///< the tracks, and behind them memory for more
  std::size_t living_ = 0;            ///< number of tracks
  GroundFilter ground_;
  VehicleSizes sizes_;
  std::int64_t next_id_ = 1;
  std::optional<Stamp> first_stamp_;
  std::optional<Stamp> last_stamp_;
  EgoError ego_error_;

  // Of the last scan, for their memory
  ScanPatches patches_;
  ScanPatches sights_;
  RangeImage view_;
  MovingCells moving_;
  GroupingMemory grouping_;
  std::vector<std::uint32_t> groups_;  ///< of the cells
  std::vector<Eigen::Vector3d> cell_points_;
  std::vector<Eigen::Vector3d> cell_directions_;
  TrafficPrior traffic_;                     ///< of the tracks
  std::vector<Expectation> expected_;        ///< of the tracks
  CellOwners owners_;                        ///< numbers of tracks
  std::vector<std::size_t> unowned_points_;  ///< of the groups
  std::vector<std::uint32_t> unowned_;       ///< cells
  CellGroups unowned_groups_;
  std::unique_ptr<GroundHeights> heights_ = std::make_unique<GroundHeights>();
  std::vector<TrackedObject> objects_;  ///< as many as tracks, and behind them memory for more
};

}  // namespace dynamic_icp::tracking
