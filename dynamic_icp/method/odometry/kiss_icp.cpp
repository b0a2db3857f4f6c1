// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/kiss_icp.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamic_icp/method/base/se3.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/estimation/robust_kernel.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/odometry/frame_steps.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"
#include "dynamic_icp/method/registration/gauss_newton.hpp"
#include "dynamic_icp/method/registration/point_to_point.hpp"

namespace dynamic_icp::odometry {
namespace {

constexpr std::size_t kPairBlock = 256;

/// Robust point-to-point registration of a scan to the map. The target frame is the predicted pose of the sensor and
/// not the world: there a step of so many rad and m means the same wherever the drive has led.
class ScanToMap final : public registration::Problem {
 public:
  ScanToMap(const Scan& source, const spatial::VoxelHashMap& map, const Eigen::Isometry3d& T_world_predicted,
            double sigma_m, const Workers& workers)
      : source_(source),
        map_(map),
        T_world_predicted_(T_world_predicted),
        max_distance_m_(3.0 * sigma_m),
        // Published is w = (k/(k + e^2))^2 with k = sigma/3: a length where the kernel takes a squared one.
        kernel_scale_(std::sqrt(sigma_m / 3.0)),
        workers_(workers) {}

  registration::Correspondences find(const Eigen::Isometry3d& T_predicted_source) override {
    const Eigen::Isometry3d T_world_source = T_world_predicted_ * T_predicted_source;
    std::vector<std::optional<spatial::Neighbour>> nearest(source_.size());
    workers_.for_each(source_.size(), kPairBlock, [&](std::size_t i) {
      nearest[i] = map_.nearest(T_world_source * source_.points()[i], max_distance_m_);
    });
    std::vector<registration::Correspondence> pairs;
    pairs.reserve(source_.size());
    for (std::uint32_t i = 0; i < source_.size(); ++i) {
      if (nearest[i]) {
        pairs.push_back({i, nearest[i]->index, nearest[i]->squared_distance});
      }
    }
    return registration::evaluated(std::move(pairs), source_.size());
  }

  [[nodiscard]] registration::Linearisation linearise(const registration::Correspondences& correspondences,
                                                      const Eigen::Isometry3d& T_predicted_source,
                                                      int /*iteration*/) const override {
    const Eigen::Isometry3d T_predicted_world = T_world_predicted_.inverse();
    const std::vector<registration::Correspondence>& pairs = correspondences.pairs;
    const auto block_sum = [&](std::size_t begin, std::size_t end) {
      registration::LinearisationSum part;
      for (std::size_t k = begin; k < end; ++k) {
        const Eigen::Vector3d q_source = T_predicted_source * source_.points()[pairs[k].source];
        const Eigen::Vector3d q = T_predicted_world * map_.point(pairs[k].target);
        const double distance = std::sqrt(pairs[k].squared_distance);
        part.add_geometry(registration::point_to_point(q_source, q), Eigen::Matrix3d::Identity(),
                          estimation::geman_mcclure_weight(distance, kernel_scale_));
      }
      return part;
    };
    return workers_.sum_blocks(pairs.size(), kPairBlock, registration::LinearisationSum{}, block_sum).finish();
  }

 private:
  const Scan& source_;
  const spatial::VoxelHashMap& map_;
  Eigen::Isometry3d T_world_predicted_;
  double max_distance_m_;
  double kernel_scale_;
  const Workers& workers_;
};

}  // namespace

ThinnedScan thin(const Scan& scan, double map_voxel_size_m) {
  ThinnedScan result;
  result.map_points = preprocess::voxel_grid(scan, {0.5 * map_voxel_size_m});
  result.registered = preprocess::voxel_grid(result.map_points, {1.5 * map_voxel_size_m});
  return result;
}

KissIcp::KissIcp(const KissIcpConfig& config, int threads)
    : config_(checked(config)),
      workers_(threads),
      map_(config_.voxel_size_m, config_.max_points_per_voxel),
      threshold_(config_.initial_threshold_m, config_.min_motion_m, config_.max_range_m),
      stream_({std::numeric_limits<double>::infinity(), config.min_points}, 0.0) {}

Frame KissIcp::process(const ScanView& raw) {
  stream_.check_order(raw.stamp);
  Frame frame;
  StageClock clock(frame.times);
  const ThinnedScan scan = thin(deskewed_in_range(raw, frame), config_.voxel_size_m);
  const Scan& source = scan.registered;
  frame.points_used = source.size();
  clock.finish(Stage::kPreprocess);

  frame.status = stream_.add(raw.stamp, source.size());
  frame.T_world_sensor = T_world_last_ * T_last_now_;
  if (is_skipped(frame.status)) {
    go_on_to(frame);
    return frame;
  }
  for (const std::uint32_t record : source.records()) {
    frame.labels[record] = 0;
  }
  if (frame.status == FrameStatus::kNotRun) {
    register_to_map(source, T_world_last_ * T_last_now_, frame);
  }
  go_on_to(frame);
  set_velocity_from_motion(frame, stream_.since_any_s());
  update_map(scan.map_points, frame.T_world_sensor);
  clock.finish(Stage::kRegistration);
  return frame;
}

/// Takes over what is finite, deskews by the last motion and crops the range; fills stamp, counts and labels.
Scan KissIcp::deskewed_in_range(const ScanView& raw, Frame& frame) const {
  Scan scan = Scan::from_raw(raw, &frame.dropped);
  if (config_.deskew) {
    scan = motion::deskew_to_middle(scan, T_last_now_);
  }
  const Scan in_range = preprocess::crop_range(scan, {config_.min_range_m, config_.max_range_m});
  frame.stamp = raw.stamp;
  frame.points = raw.points.size();
  frame.dropped.out_of_range = scan.size() - in_range.size();
  frame.labels.assign(frame.points, -1);
  frame.sweep = motion::sweep_in_data(raw);
  frame.sweep->deskewed = config_.deskew && frame.sweep->duration_s.value_or(0.0) > 0.0;
  return in_range;
}

void KissIcp::register_to_map(const Scan& source, const Eigen::Isometry3d& T_world_predicted, Frame& frame) {
  registration::StopRule stop;
  stop.max_iterations = config_.max_iterations;
  stop.min_step = config_.min_step;
  ScanToMap problem(source, map_, T_world_predicted, threshold_.sigma_m(), workers_);
  frame.alignment =
      registration::minimise(problem, Eigen::Isometry3d::Identity(), registration::typical_distance(source), stop);
  frame.status = frame_status(frame.alignment.status);
  Eigen::Isometry3d T_predicted_registered = Eigen::Isometry3d::Identity();
  if (is_aligned(frame.status)) {
    T_predicted_registered = frame.alignment.T_target_source;
  }
  frame.T_world_sensor = T_world_predicted * T_predicted_registered;
  threshold_.observe(T_predicted_registered, frame.T_world_sensor.translation().norm());
}

void KissIcp::update_map(const Scan& points, const Eigen::Isometry3d& T_world_sensor) {
  std::vector<Eigen::Vector3d> in_world;
  in_world.reserve(points.size());
  for (const Eigen::Vector3d& point : points.points()) {
    in_world.emplace_back(T_world_sensor * point);
  }
  map_.add(in_world);
  map_.remove_far(T_world_sensor.translation(), config_.max_range_m);
}

/// Makes the frame's pose the last one and the motion to it the prediction of the next.
void KissIcp::go_on_to(Frame& frame) {
  // Each pose is a product of the two before it: what a rotation lacks in orthogonality would grow exponentially.
  frame.T_world_sensor.linear() = Eigen::Quaterniond(frame.T_world_sensor.linear()).normalized().toRotationMatrix();
  T_last_now_ = T_world_last_.inverse() * frame.T_world_sensor;
  T_world_last_ = frame.T_world_sensor;
  frame.T_target_source = T_last_now_.inverse();
}

void KissIcp::state(StateArchive& archive) { archive(map_, threshold_, stream_, T_world_last_, T_last_now_); }

}  // namespace dynamic_icp::odometry
