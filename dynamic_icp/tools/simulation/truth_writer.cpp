// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/truth_writer.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/stamp.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::simulation {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kMotionSamples = 20;  // a scan

constexpr const char* kErrorFolder = "doppler_error";

bool has_systematic_error(const FmcwLidarConfig& lidar) {
  return lidar.doppler_bias_mps != 0.0 || has_systematic_error(lidar.doppler_error);
}

Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json object_json(const ObjectTruth& object) {
  const Eigen::Quaterniond q(object.T_sensor_body.linear());
  return {{"id", object.id},
          {"kind", object.name},
          {"velocity_sensor", to_json(object.velocity_sensor)},
          {"center_sensor", to_json(object.center_sensor)},
          {"size", to_json(object.size)},
          {"orientation_sensor_xyzw", {q.x(), q.y(), q.z(), q.w()}},
          {"yaw_rate", object.yaw_rate_rps},
          {"points", object.points}};
}

/// "x y z qx qy qz qw" with the given separator.
std::string pose_text(const Eigen::Isometry3d& T, char separator) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return fmt::format("{1:.9f}{0}{2:.9f}{0}{3:.9f}{0}{4:.12f}{0}{5:.12f}{0}{6:.12f}{0}{7:.12f}", separator, t.x(), t.y(),
                     t.z(), q.x(), q.y(), q.z(), q.w());
}

std::string vector_text(const Eigen::Vector3d& v) { return fmt::format("{:.9f},{:.9f},{:.9f}", v.x(), v.y(), v.z()); }

void write_calibration(const fs::path& folder, const Eigen::Isometry3d& T_vehicle_sensor) {
  const Eigen::Vector3d t = T_vehicle_sensor.translation();
  const Eigen::Quaterniond q(T_vehicle_sensor.linear());
  const Json json = {{"T_V_to_S",
                      {{"translation", {{"x", t.x()}, {"y", t.y()}, {"z", t.z()}}},
                       {"quaternion", {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}}}}};
  formats::write_whole_file(folder / "calibration.json", json.dump(2) + "\n");
}

}  // namespace

std::vector<std::int32_t> labels_of(const SimulatedFrame& frame) {
  std::vector<std::int32_t> labels = frame.scan.bodies;
  for (std::int32_t& label : labels) {
    const bool moving = std::any_of(frame.objects.begin(), frame.objects.end(),
                                    [&](const ObjectTruth& object) { return object.id == label; });
    label = moving || label == kNoBody ? label : 0;
  }
  return labels;
}

TruthWriter::TruthWriter(const fs::path& folder, const Simulation& simulation, std::size_t sensor,
                         const TruthOptions& options)
    : folder_(folder),
      simulation_(simulation),
      sensor_(sensor),
      options_(options),
      poses_(folder / "ref_poses.txt"),
      ego_(folder / "ego.jsonl"),
      motion_(folder / "motion.csv"),
      objects_(folder / "objects.jsonl"),
      systematic_error_(has_systematic_error(simulation.config().rig.sensors.at(sensor).lidar)) {
  formats::make_folder(folder_ / "labels");
  if (options_.point_truth) {
    formats::make_folder(folder_ / "truth");
  }
  if (options_.point_truth && systematic_error_) {
    formats::make_folder(folder_ / kErrorFolder);
  }
  if (simulation.config().rig.sensors.at(sensor).lidar.timing.stamp_jitter_s > 0.0) {
    stamps_.emplace(folder / "stamps.csv");
    stamps_->write("index,stamp,begin\n");
  }
  if (options_.vehicle_poses) {
    write_calibration(folder_, T_vehicle_sensor(simulation_.config().rig.sensors.at(sensor_).mount));
  }
  motion_.write("timestamp,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n");
}

void TruthWriter::add(const SimulatedFrame& frame) {
  const std::string name = fmt::format("{:05}.bin", scans_ + 1);
  formats::write_values<std::int32_t>(folder_ / "labels" / name, labels_of(frame));
  if (options_.point_truth) {
    std::vector<double> truth;
    truth.reserve(2 * frame.scan.bodies.size());
    for (std::size_t i = 0; i < frame.scan.bodies.size(); ++i) {
      truth.push_back(frame.scan.true_range[i]);
      truth.push_back(frame.scan.true_doppler[i]);
    }
    formats::write_values<double>(folder_ / "truth" / name, truth);
  }
  if (options_.point_truth && systematic_error_) {
    formats::write_values<double>(folder_ / kErrorFolder / name, frame.scan.systematic_error);
  }
  if (stamps_) {
    stamps_->write(fmt::format("{},{},{}\n", scans_, format_seconds(written_stamp(frame)),
                               format_seconds({frame.begin.ns + options_.epoch_ns})));
  }
  if (scans_ == 0) {
    T_first_world_ = frame.sensor.T_world_sensor.inverse();
  }
  add_pose(frame);
  add_objects(frame);
  add_ego(frame);
  add_motion_until(frame.index + 1);
  ++scans_;
}

void TruthWriter::add_pose(const SimulatedFrame& frame) {
  Eigen::Isometry3d T = T_first_world_ * frame.sensor.T_world_sensor;
  if (scans_ == 0) {
    T.setIdentity();  // not even rounding errors in the first pose
  }
  if (options_.vehicle_poses) {
    const Eigen::Isometry3d T_sensor_vehicle =
        T_vehicle_sensor(simulation_.config().rig.sensors.at(sensor_).mount).inverse();
    T = T_sensor_vehicle.inverse() * T * T_sensor_vehicle;
  }
  poses_.write(fmt::format("{} {}\n", format_seconds(written_stamp(frame)), pose_text(T, ' ')));
}

void TruthWriter::add_objects(const SimulatedFrame& frame) {
  Json objects = Json::array();
  for (const ObjectTruth& object : frame.objects) {
    objects.push_back(object_json(object));
  }
  objects_.write(fmt::format("{},\"objects\":{}}}\n", line_start(frame), objects.dump()));
}

void TruthWriter::add_ego(const SimulatedFrame& frame) {
  ego_.write(fmt::format("{},\"velocity_sensor\":{},\"angular_velocity_sensor\":{}}}\n", line_start(frame),
                         to_json(frame.sensor.velocity_sensor).dump(),
                         to_json(frame.sensor.angular_velocity_sensor).dump()));
}

/// Of the scans before this one that have no rows yet, lost ones, too.
void TruthWriter::add_motion_until(std::size_t scan) {
  for (; motion_scans_ < scan; ++motion_scans_) {
    const Stamp begin = simulation_.stamp(motion_scans_);
    const Stamp end = simulation_.stamp(motion_scans_ + 1);
    for (int i = 0; i < kMotionSamples; ++i) {
      const Stamp stamp{begin.ns + (end.ns - begin.ns) * i / kMotionSamples};
      const SensorState state = simulation_.sensor_state(seconds_between(Stamp{}, stamp), sensor_);
      motion_.write(fmt::format("{},{},{},{}\n", format_seconds({stamp.ns + options_.epoch_ns}),
                                pose_text(T_first_world_ * state.T_world_sensor, ','),
                                vector_text(state.velocity_sensor), vector_text(state.angular_velocity_sensor)));
    }
  }
}

void TruthWriter::finish() {
  add_motion_until(simulation_.size());
  if (stamps_) {
    stamps_->close();
  }
  poses_.close();
  ego_.close();
  motion_.close();
  objects_.close();
}

Stamp TruthWriter::written_stamp(const SimulatedFrame& frame) const {
  return {frame.scan.measured.stamp.ns + options_.epoch_ns};
}

std::string TruthWriter::line_start(const SimulatedFrame& frame) const {
  // The exact stamp as a number, which a double could not hold.
  return fmt::format("{{\"index\":{},\"timestamp\":{}", scans_, format_seconds(written_stamp(frame)));
}

}  // namespace dynamic_icp::simulation
