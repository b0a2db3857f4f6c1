// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kOffTruth_deg = 8.0;  // at walking pace in a jam a few degrees are noise
constexpr double kOffAhead_deg = 8.0;
constexpr double kOffAheadInTurns_deg = 15.0;  // the sensor swings out: it is not where the wheels are
constexpr double kDeskewed_rps = 0.06;
constexpr double kSigmas = 3.0;
constexpr double kWellKnown_deg = 5.0;  // a direction known no better is not told

/// How well the mean direction is known: by the scatter of the stretches, each as one, for scans of a stretch err
/// alike.
double direction_error_deg(const Evidence& evidence, const Eigen::Vector3d& mean) {
  std::vector<double> off;
  for (std::size_t k = 0; k < evidence.looks.size(); k += kLooksOfStretch) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = k; i < std::min(k + kLooksOfStretch, evidence.looks.size()); ++i) {
      const ScanLook& look = evidence.looks[i];
      sum += look.has_velocity() ? look.ego.velocity_sensor : Eigen::Vector3d(Eigen::Vector3d::Zero());
    }
    if (sum.norm() > kDirectionKnown_mps) {
      off.push_back(std::acos(std::clamp(std::abs(sum.normalized().dot(mean.normalized())), 0.0, 1.0)) / kDegree);
    }
  }
  constexpr double kErrorPerMedian = 1.4826 * 1.2533;  // as median_error has it
  return off.empty() ? 180.0 : kErrorPerMedian * quantile(off, 0.5) / std::sqrt(static_cast<double>(off.size()));
}

/// The mean direction in which the Doppler moves the sensor, its sign put right.
Eigen::Vector3d mean_direction(const Evidence& evidence) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ScanLook& look : evidence.looks) {
    if (look.has_velocity() && look.ego.velocity_sensor.norm() > kDirectionKnown_mps) {
      sum += look.ego.velocity_sensor.normalized();
    }
  }
  const Comparison* reference = evidence.reference();
  const bool is_turned_round = reference != nullptr && reference->ratio < 0.0;
  return (is_turned_round ? -1.0 : 1.0) * sum;
}

/// Between ground truth and points; nothing where only one of them tells.
std::optional<double> off_truth_deg(const Evidence& evidence) {
  if (!evidence.truth.tells() || evidence.truth.doppler_speed_mps < kDirectionKnown_mps) {
    return std::nullopt;
  }
  const double off = evidence.truth.turned_deg;
  const Comparison* reference = evidence.reference();
  return reference != nullptr && reference->ratio < 0.0 ? 180.0 - off : off;
}

}  // namespace

Finding mounting(const Evidence& evidence) {
  Finding finding{Question::kMounting, Verdict::kCannotTell, ""};
  const Eigen::Vector3d direction = mean_direction(evidence);
  if (direction.norm() < 1e-6) {
    finding.sentence = "the Doppler shows no motion from which to infer the mounting";
    return finding;
  }
  const double yaw_deg = std::atan2(direction.y(), direction.x()) / kDegree;
  const double pitch_deg = std::atan2(direction.z(), direction.head<2>().norm()) / kDegree;
  const double ahead_deg = std::atan2(direction.tail<2>().norm(), direction.x()) / kDegree;
  finding.evidence = {{"moves_to_the_left_deg", yaw_deg}, {"moves_up_deg", pitch_deg}};
  const std::optional<double> off_truth = off_truth_deg(evidence);
  if (off_truth) {
    finding.evidence.emplace_back("off_ground_truth_deg", *off_truth);
  }
  const double error_deg = direction_error_deg(evidence, direction);
  finding.evidence.emplace_back("direction_error_deg", error_deg);
  const Comparison* reference = evidence.reference();
  const bool is_straight = reference != nullptr && reference->yaw_rate_rps < kDeskewed_rps;
  if (error_deg > kWellKnown_deg) {
    finding.sentence = fmt::format(
        "the direction in which the Doppler moves the sensor scatters too much to decide: {:.0f} degrees off its x "
        "axis, "
        "+- {:.0f}",
        ahead_deg, error_deg);
    return finding;
  }
  if (off_truth && *off_truth > kOffTruth_deg + kSigmas * evidence.truth.turned_error_deg) {
    finding.verdict = Verdict::kWrong;
    finding.sentence = fmt::format(
        "points and ground truth have different axes: {:.0f} degrees between the directions in which they move",
        *off_truth);
    return finding;
  }
  const std::string travel =
      std::abs(yaw_deg) > 135.0
          ? fmt::format("the sensor looks back, or the vehicle does not drive ahead ({:.0f} degrees from x)", ahead_deg)
          : fmt::format(
                "the sensor is rotated: the direction of travel is {:.0f} degrees to the left of its x axis and "
                "{:.0f} degrees above",
                yaw_deg, pitch_deg);
  if (ahead_deg > (is_straight ? kOffAhead_deg : kOffAheadInTurns_deg)) {
    finding.verdict = Verdict::kSuspicious;
    finding.sentence = travel + (off_truth ? "; ground truth agrees" : "") + "; the methods need no x axis ahead";
  } else if (ahead_deg > kOffAhead_deg && !is_straight) {
    finding.sentence = fmt::format("{:.0f} degrees off in turns: the sensor swings out there", ahead_deg);
  } else {
    finding.verdict = Verdict::kOk;
    finding.sentence = fmt::format("direction of travel within {:.1f} degrees of the sensor's x axis", ahead_deg);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
