// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "python/src/frame_members.hpp"

#include <array>
#include <string>

namespace dynamic_icp::python {
namespace {

constexpr std::array<const char*, tracking::kFaces.size()> kFaceNames = {"front", "rear", "left",
                                                                         "right", "top",  "bottom"};

py::dict box_members(const tracking::TrackedObject& object) {
  py::dict faces;
  for (std::size_t i = 0; i < kFaceNames.size(); ++i) {
    faces[kFaceNames[i]] = std::string(to_string(object.faces[i]));
  }
  py::dict box;
  box["center"] = copied(object.box.centre);
  box["axes"] = copied(object.box.axes);
  box["size"] = copied(object.box.size);
  box["center_covariance"] = copied(object.centre_covariance);
  box["faces"] = faces;
  return box;
}

py::dict prediction_members(const tracking::ObjectPrediction& prediction) {
  py::dict members;
  members["after_s"] = prediction.after_s;
  members["center"] = copied(prediction.centre);
  members["center_covariance"] = copied(prediction.centre_covariance);
  members["velocity"] = copied(prediction.velocity_sensor);
  return members;
}

py::dict motion_members(const tracking::MotionProbabilities& motion) {
  py::dict members;
  members["standing"] = motion.standing;
  members["straight"] = motion.straight;
  members["turning"] = motion.turning;
  return members;
}

py::dict object_members(const tracking::TrackedObject& object) {
  py::dict members;
  members["id"] = object.id;
  members["velocity"] = copied(object.velocity_sensor);
  members["velocity_covariance"] = copied(object.covariance);
  members["centroid"] = copied(object.centroid);
  members["extent"] = copied(object.extent);
  members["points"] = object.members.size();
  members["box"] = box_members(object);
  members["prediction"] = prediction_members(object.prediction);
  members["tangential_observed"] = object.tangential_observed;
  members["yaw_rate"] = object.yaw_rate_rps;
  members["acceleration"] = object.acceleration_mps2;
  members["motion"] = motion_members(object.motion);
  if (object.divided_from > 0) {
    members["divided_from"] = object.divided_from;
  }
  members["status"] = std::string(to_string(object.status));
  members["age_scans"] = object.age_scans;
  members["scans_seen"] = object.scans_seen;
  return members;
}

py::dict object_members(std::size_t id, const dynamics::ObjectEstimate& object) {
  py::dict members;
  members["id"] = id;
  members["velocity"] = copied(object.velocity_sensor);
  members["velocity_covariance"] = copied(object.covariance);
  members["centroid"] = copied(object.centroid);
  members["extent"] = copied(object.extent);
  members["points"] = object.members.size();
  return members;
}

/// Tracked objects, or the accepted clusters of methods that do not track: as in objects.jsonl.
py::list object_list(const odometry::Frame& frame) {
  py::list objects;
  for (const tracking::TrackedObject& object : frame.tracked) {
    objects.append(object_members(object));
  }
  for (const dynamics::ObjectEstimate& cluster : frame.clusters) {
    if (cluster.verdict == dynamics::ClusterVerdict::kAccepted) {
      objects.append(object_members(objects.size() + 1, cluster));
    }
  }
  return objects;
}

py::dict dropped_members(const Scan::Dropped& dropped) {
  py::dict members;
  members["non_finite"] = dropped.non_finite;
  members["implausible"] = dropped.implausible;
  members["zero_range"] = dropped.zero_range;
  members["out_of_range"] = dropped.out_of_range;
  members["flagged"] = dropped.flagged;
  return members;
}

py::dict milliseconds(const odometry::StageTimes& times) {
  py::dict members;
  for (std::size_t k = 0; k < odometry::kStageCount; ++k) {
    members[py::str(std::string(to_string(static_cast<odometry::Stage>(k))))] = times.ms[k];
  }
  members["total"] = times.total_ms;
  return members;
}

py::array_t<double> unobservable(const registration::Alignment& alignment) {
  Eigen::MatrixXd directions(alignment.degenerate.size(), 6);
  for (std::size_t i = 0; i < alignment.degenerate.size(); ++i) {
    directions.row(static_cast<Eigen::Index>(i)) = alignment.degenerate[i].direction.transpose();
  }
  return copied(directions);
}

}  // namespace

py::dict ego_members(const ego_motion::EgoVelocity& ego) {
  py::dict members;
  members["velocity"] = copied(ego.velocity_sensor);
  members["covariance"] = copied(ego.covariance);
  members["status"] = std::string(to_string(ego.status));
  members["unobservable"] = copied(ego.unobservable);
  members["acceleration"] = copied(ego.acceleration_sensor);
  members["reference_time"] = ego.reference_time_s;
  members["bias"] = ego.bias_mps;
  members["bias_variance"] = ego.bias_variance;
  members["points"] = ego.points;
  members["inliers"] = ego.inliers;
  members["inlier_rms"] = ego.inlier_rms_mps;
  members["iterations"] = ego.iterations;
  return members;
}

py::dict frame_members(odometry::Frame frame) {
  py::dict members;
  members["stamp_ns"] = frame.stamp.ns;
  members["status"] = std::string(verdict(frame.status));
  members["reason"] = std::string(to_string(frame.status));
  members["pose"] = copied(frame.T_world_sensor);
  members["motion"] = copied(frame.T_target_source);
  members["covariance"] = copied_or_none(frame.alignment.covariance);
  members["ego"] = ego_members(frame.ego);
  members["twist"] = py::none();
  members["twist_covariance"] = py::none();
  if (frame.twist) {
    members["twist"] = copied((Vector6d() << frame.twist->angular, frame.twist->linear).finished());
    members["twist_covariance"] = copied(frame.twist->covariance);
  }
  members["objects"] = object_list(frame);
  members["unobservable"] = unobservable(frame.alignment);
  members["information_ratio"] = frame.alignment.information_ratio;
  members["iterations"] = frame.alignment.iterations;
  members["fitness"] = frame.alignment.fitness;
  members["inlier_rmse"] = frame.alignment.inlier_rmse;
  members["correspondences"] = frame.alignment.correspondences;
  members["points"] = frame.points;
  members["points_used"] = frame.points_used;
  members["dropped"] = dropped_members(frame.dropped);
  members["dynamic_candidates"] = frame.dynamic_candidates;
  members["dynamic_clustered"] = frame.dynamic_clustered;
  members["dynamic_refined"] = frame.dynamic_refined;
  members["deskewed"] = frame.sweep.has_value() && frame.sweep->deskewed;
  members["milliseconds"] = milliseconds(frame.times);
  members["static_points"] = moved(std::move(frame.static_points));
  members["labels"] = moved(std::move(frame.labels));
  return members;
}

}  // namespace dynamic_icp::python
