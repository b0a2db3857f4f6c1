// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/frame_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace dynamic_icp::runs {
namespace {

using Json = nlohmann::ordered_json;
using odometry::Frame;

template <class Derived>
Json vector_json(const Eigen::MatrixBase<Derived>& vector) {
  Json values = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) {
    values.push_back(vector[i]);
  }
  return values;
}

template <class Derived>
Json matrix_json(const Eigen::MatrixBase<Derived>& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    rows.push_back(vector_json(matrix.row(i).transpose()));
  }
  return rows;
}

/// The stamp as a JSON number with all nine decimals: a double could not carry them.
std::string stamped(std::size_t index, Stamp stamp, const Json& rest) {
  const std::string members = rest.dump();
  return fmt::format("{{\"index\":{},\"timestamp\":{},{}", index, format_seconds(stamp), members.substr(1));
}

Json times_json(const odometry::StageTimes& times) {
  Json ms;
  for (std::size_t k = 0; k < odometry::kStageCount; ++k) {
    ms[std::string(to_string(static_cast<odometry::Stage>(k)))] = times.ms[k];
  }
  ms["total"] = times.total_ms;
  return ms;
}

Json ego_json(const ego_motion::EgoVelocity& ego) {
  return {{"velocity", vector_json(ego.velocity_sensor)},
          {"covariance", matrix_json(ego.covariance)},
          {"status", to_string(ego.status)},
          {"iterations", ego.iterations},
          {"points", ego.points},
          {"inliers", ego.inliers},
          {"inlier_rms", ego.inlier_rms_mps}};
}

Json degenerate_json(const registration::Alignment& alignment) {
  Json directions = Json::array();
  for (const estimation::DegenerateDirection& direction : alignment.degenerate) {
    directions.push_back({{"direction", vector_json(direction.direction)}, {"information", direction.information}});
  }
  return directions;
}

Json covariance_json(const registration::Alignment& alignment) {
  return alignment.covariance ? matrix_json(*alignment.covariance) : Json(nullptr);
}

Json twist_json(const std::optional<motion::Twist>& twist) {
  if (!twist) {
    return nullptr;
  }
  return {{"angular", vector_json(twist->angular)},
          {"linear", vector_json(twist->linear)},
          {"covariance", matrix_json(twist->covariance)}};
}

Json term_json(const registration::TermStatistics& term) {
  return {{"count", term.count}, {"inliers", term.inliers}, {"rms", term.rms}};
}

Json object_json(std::size_t id, const dynamics::ObjectEstimate& object) {
  return {{"id", id},
          {"velocity", vector_json(object.velocity_sensor)},
          {"velocity_covariance", matrix_json(object.covariance)},
          {"centroid", vector_json(object.centroid)},
          {"extent", vector_json(object.extent)},
          {"points", object.members.size()}};
}

Json box_json(const tracking::TrackedObject& object) {
  const tracking::OrientedBox& box = object.box;
  const Eigen::Quaterniond orientation(box.axes);
  const auto face = [&](tracking::Face which) { return to_string(object.faces[index_of(which)]); };
  return {{"center", vector_json(box.centre)},
          {"center_covariance", matrix_json(object.centre_covariance)},
          {"size", vector_json(box.size)},
          {"orientation_xyzw", vector_json(orientation.coeffs())},
          {"faces",
           {{"front", face(tracking::Face::kFront)},
            {"rear", face(tracking::Face::kRear)},
            {"left", face(tracking::Face::kLeft)},
            {"right", face(tracking::Face::kRight)},
            {"top", face(tracking::Face::kTop)},
            {"bottom", face(tracking::Face::kBottom)}}}};
}

Json prediction_json(const tracking::ObjectPrediction& prediction) {
  return {{"after_s", prediction.after_s},
          {"center", vector_json(prediction.centre)},
          {"center_covariance", matrix_json(prediction.centre_covariance)},
          {"velocity", vector_json(prediction.velocity_sensor)}};
}

Json tracked_json(const tracking::TrackedObject& object) {
  return {{"id", object.id},
          {"divided_from", object.divided_from > 0 ? Json(object.divided_from) : Json(nullptr)},
          {"velocity", vector_json(object.velocity_sensor)},
          {"velocity_covariance", matrix_json(object.covariance)},
          {"tangential_observed", object.tangential_observed},
          {"yaw_rate", object.yaw_rate_rps},
          {"acceleration", object.acceleration_mps2},
          {"motion",
           {{"standing", object.motion.standing},
            {"straight", object.motion.straight},
            {"turning", object.motion.turning}}},
          {"centroid", vector_json(object.centroid)},
          {"extent", vector_json(object.extent)},
          {"box", box_json(object)},
          {"prediction", prediction_json(object.prediction)},
          {"status", to_string(object.status)},
          {"age_scans", object.age_scans},
          {"points", object.members.size()}};
}

/// Tracked objects, or the accepted clusters of methods that do not track.
Json objects_json(const Frame& frame) {
  Json objects = Json::array();
  for (const tracking::TrackedObject& object : frame.tracked) {
    objects.push_back(tracked_json(object));
  }
  for (const dynamics::ObjectEstimate& cluster : frame.clusters) {
    if (cluster.verdict == dynamics::ClusterVerdict::kAccepted) {
      objects.push_back(object_json(objects.size() + 1, cluster));
    }
  }
  return objects;
}

/// How many clusters were rejected for which reason.
Json rejected_json(const Frame& frame) {
  Json rejected = Json::object();
  for (const dynamics::ObjectEstimate& cluster : frame.clusters) {
    if (cluster.verdict != dynamics::ClusterVerdict::kAccepted) {
      Json& count = rejected[std::string(to_string(cluster.verdict))];
      count = count.is_null() ? 1 : count.get<int>() + 1;
    }
  }
  return rejected;
}

}  // namespace

std::string frame_line(std::size_t index, const Frame& frame) {
  const registration::Alignment& alignment = frame.alignment;
  Json line = {{"points", frame.points},
               {"points_used", frame.points_used},
               {"points_dropped",
                {{"non_finite", frame.dropped.non_finite},
                 {"implausible", frame.dropped.implausible},
                 {"zero_range", frame.dropped.zero_range},
                 {"out_of_range", frame.dropped.out_of_range},
                 {"flagged", frame.dropped.flagged}}},
               {"ego_velocity", vector_json(frame.ego.velocity_sensor)},
               {"ego_velocity_covariance", matrix_json(frame.ego.covariance)},
               {"ego_velocity_status", to_string(frame.ego.status)},
               {"dynamic_candidates", frame.dynamic_candidates},
               {"dynamic_clustered", frame.dynamic_clustered},
               {"dynamic_refined", frame.dynamic_refined},
               {"clusters_rejected", rejected_json(frame)},
               {"iterations", alignment.iterations},
               {"converged", odometry::converged(frame.status)},
               {"status", verdict(frame.status)},
               {"reason", to_string(frame.status)},
               {"fitness", alignment.fitness},
               {"inlier_rmse", alignment.inlier_rmse},
               {"pose_covariance", covariance_json(alignment)},
               {"twist", twist_json(frame.twist)},
               {"doppler_bias", frame.ego.bias_mps},
               {"information_ratio", alignment.information_ratio},
               {"degenerate", degenerate_json(alignment)},
               {"ms", times_json(frame.times)}};
  if (frame.ego.rotation) {
    line["angular_velocity_doppler"] = vector_json(frame.ego.rotation->omega);
    line["angular_velocity_doppler_covariance"] = matrix_json(frame.ego.rotation->covariance);
  }
  return stamped(index, frame.stamp, line);
}

std::string objects_line(std::size_t index, const Frame& frame) {
  return stamped(index, frame.stamp, {{"objects", objects_json(frame)}});
}

std::string pair_document(const Frame& source, const Frame& target, const std::vector<std::string>& assumptions) {
  const registration::Alignment& alignment = target.alignment;
  const Json document = {{"status", verdict(target.status)},
                         {"reason", to_string(target.status)},
                         {"converged", odometry::converged(target.status)},
                         {"assumptions", assumptions},
                         {"dt", seconds_between(source.stamp, target.stamp)},
                         {"T_target_source", matrix_json(target.T_target_source.matrix())},
                         {"covariance", covariance_json(alignment)},
                         {"iterations", alignment.iterations},
                         {"fitness", alignment.fitness},
                         {"inlier_rmse", alignment.inlier_rmse},
                         {"correspondences", alignment.correspondences},
                         {"geometry_residual_m", term_json(alignment.geometry)},
                         {"doppler_residual_mps", term_json(alignment.doppler)},
                         {"information_ratio", alignment.information_ratio},
                         {"degenerate", degenerate_json(alignment)},
                         {"source",
                          {{"points", source.points},
                           {"points_used", source.points_used},
                           {"ego_velocity", ego_json(source.ego)},
                           {"objects", objects_json(source)},
                           {"clusters_rejected", rejected_json(source)}}},
                         {"target",
                          {{"points", target.points},
                           {"points_used", target.points_used},
                           {"ego_velocity", ego_json(target.ego)},
                           {"objects", objects_json(target)},
                           {"clusters_rejected", rejected_json(target)}}},
                         {"ms", times_json(target.times)}};
  return document.dump(2);
}

}  // namespace dynamic_icp::runs
