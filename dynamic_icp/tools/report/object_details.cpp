// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/object_details.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>

namespace dynamic_icp::report {
namespace {

using runs::ObjectRow;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kSigmaDigits = 3;  // significant ones

/// Along a direction that need not have unit length; NaN where it has none, or the matrix is no covariance.
double sigma_along(const Eigen::Matrix3d& covariance, const Eigen::Vector3d& direction) {
  return std::sqrt(direction.dot(covariance * direction)) / direction.norm();
}

Eigen::Vector3d level(const Eigen::Vector3d& v) { return {v.x(), v.y(), 0.0}; }

Eigen::Vector3d across(const Eigen::Vector3d& v) { return {-v.y(), v.x(), 0.0}; }

double largest_sigma(const Eigen::Matrix3d& covariance) {
  if (!covariance.allFinite()) {
    return kNaN;
  }
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[2]);
}

/// One letter a face.
std::string letters(const std::array<std::string, 6>& faces) {
  std::string text;
  for (const std::string& face : faces) {
    text += face == "seen" || face == "hidden" ? face.front() : 'u';
  }
  return text;
}

Json details(const ObjectRow& object) {
  if (!object.track) {
    return nullptr;
  }
  const ObjectSigmas sigma = object_sigmas(object);
  Json entry = {object.track->age_scans, object.track->tangential_observed, letters(object.track->faces)};
  for (const double value :
       {sigma.speed_mps, sigma.heading_deg, sigma.radial_mps, sigma.tangential_mps, sigma.centre_m}) {
    entry.push_back(significant(value, kSigmaDigits));
  }
  return entry;
}

}  // namespace

ObjectSigmas object_sigmas(const ObjectRow& object) {
  if (!object.track) {
    return {kNaN, kNaN, kNaN, kNaN, kNaN};
  }
  const Eigen::Matrix3d& covariance = object.track->velocity_covariance;
  const Eigen::Vector3d centre = object.box ? object.box->centre : object.centroid;
  const Eigen::Vector3d course = level(object.velocity);
  const double heading_rad = sigma_along(covariance, across(course)) / course.norm();
  return {.speed_mps = sigma_along(covariance, object.velocity),
          // Beyond half a turn nothing is known of a direction.
          .heading_deg = std::isnan(heading_rad) ? kNaN : std::min(180.0, heading_rad * 180.0 / std::numbers::pi),
          .radial_mps = sigma_along(covariance, centre),
          .tangential_mps = sigma_along(covariance, across(centre)),
          .centre_m = largest_sigma(object.track->centre_covariance)};
}

Json object_details(const runs::RunFiles& run) {
  const auto is_tracked = [](const ObjectRow& object) { return object.track.has_value(); };
  const auto has_tracked = [&](const std::vector<ObjectRow>& list) {
    return std::any_of(list.begin(), list.end(), is_tracked);
  };
  if (std::none_of(run.objects.begin(), run.objects.end(), has_tracked)) {
    return nullptr;
  }
  Json frames = Json::array();
  for (const std::vector<ObjectRow>& list : run.objects) {
    Json entries = Json::array();
    std::transform(list.begin(), list.end(), std::back_inserter(entries), details);
    frames.push_back(entries);
  }
  return frames;
}

}  // namespace dynamic_icp::report
