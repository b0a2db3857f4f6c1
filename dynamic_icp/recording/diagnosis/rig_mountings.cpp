// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/questions.hpp"
#include "dynamic_icp/recording/diagnosis/rig_hypotheses.hpp"
#include "dynamic_icp/recording/diagnosis/rig_offsets.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr double kWellKnown_rad = 10.0 * kDegree;  // a direction known no better proves nothing
constexpr double kMixedUp_rad = 10.0 * kDegree;    // no mounting moves so far by itself

/// Who agrees with whom.
struct Judgement {
  std::size_t leader = 0;          ///< the sensor that most agree with
  std::vector<std::size_t> wrong;  ///< those that contradict it
  bool is_decided = true;          ///< more agree with the leader than with any of those
};

/// Of two sensors that contradict each other: the one that moves clearly more as the ground truth does.
void decide_by_truth(const std::vector<RigLook>& rig_looks, Judgement& judgement) {
  constexpr double kClearly = 0.5;
  const bool has_truth = std::ranges::all_of(rig_looks, [](const RigLook& rig_look) { return rig_look.has_truth; });
  const Offset of_leader = offset(rig_looks, 2, judgement.leader, {});
  const Offset of_other = offset(rig_looks, 2, 1 - judgement.leader, {});
  if (!has_truth || !of_leader.is_known || !of_other.is_known) {
    return;  // as many agree
  }
  const double leader_rad = of_leader.angle_rad();
  const double other_rad = of_other.angle_rad();
  judgement.is_decided = std::min(leader_rad, other_rad) < kClearly * std::max(leader_rad, other_rad);
  if (judgement.is_decided && other_rad < leader_rad) {
    judgement.wrong = {judgement.leader};
    judgement.leader = 1 - judgement.leader;
  }
}

/// Sensors, itself among them, and the direction of travel that do not contradict sensor `k`.
int votes(const std::vector<RigLook>& rig_looks, std::size_t sensors, std::size_t k) {
  int agreeing = 1;
  for (std::size_t other = 0; other <= sensors; ++other) {
    const Offset off = other != k ? offset(rig_looks, other, k, {}) : Offset{};
    agreeing += off.is_known && !off.contradicts() ? 1 : 0;
  }
  return agreeing;
}

/// How little is known of the direction of sensor `k`, next to the others.
double vagueness(const std::vector<RigLook>& rig_looks, std::size_t sensors, std::size_t k) {
  double sum = 0.0;
  for (std::size_t other = 0; other < sensors; ++other) {
    const Offset off = other != k ? offset(rig_looks, other, k, {}) : Offset{};
    sum += std::min(off.left_limit_rad, std::numbers::pi) + std::min(off.up_limit_rad, std::numbers::pi);
  }
  return sum;
}

Judgement judge(const std::vector<RigLook>& rig_looks, std::size_t sensors) {
  std::vector<int> agreeing;
  for (std::size_t k = 0; k < sensors; ++k) {
    agreeing.push_back(votes(rig_looks, sensors, k));
  }
  Judgement judgement;
  for (std::size_t k = 1; k < sensors; ++k) {
    const bool is_clearer = agreeing[k] == agreeing[judgement.leader] &&
                            vagueness(rig_looks, sensors, k) < vagueness(rig_looks, sensors, judgement.leader);
    if (agreeing[k] > agreeing[judgement.leader] || is_clearer) {
      judgement.leader = k;
    }
  }
  for (std::size_t k = 0; k < sensors; ++k) {
    if (k != judgement.leader && offset(rig_looks, judgement.leader, k, {}).contradicts()) {
      judgement.wrong.push_back(k);
      judgement.is_decided = judgement.is_decided && agreeing[judgement.leader] > agreeing[k];
    }
  }
  if (sensors == 2 && !judgement.wrong.empty()) {
    decide_by_truth(rig_looks, judgement);
  }
  return judgement;
}

/// One standard deviation of what the limit allows for.
double sigma_deg(double limit_rad) { return limit_rad / kCertain / kDegree; }

/// "2.0 degrees (+- 0.3) to the left of where sensor 0 has it move": of the parts that contradict.
std::string offset_in_words(const Offset& off) {
  if (off.angle_rad() > kMixedUp_rad) {
    return fmt::format("{:.0f} degrees (+- {:.0f}) off", off.angle_rad() / kDegree, sigma_deg(off.limit_rad()));
  }
  std::vector<std::string> parts;
  if (std::abs(off.left_rad) > off.left_limit_rad) {
    parts.push_back(fmt::format("{:.1f} degrees (+- {:.1f}) to the {}", std::abs(off.left_rad) / kDegree,
                                sigma_deg(off.left_limit_rad), off.left_rad > 0.0 ? "left" : "right"));
  }
  if (std::abs(off.up_rad) > off.up_limit_rad) {
    parts.push_back(fmt::format("{:.1f} degrees (+- {:.1f}) {}", std::abs(off.up_rad) / kDegree,
                                sigma_deg(off.up_limit_rad), off.up_rad > 0.0 ? "up" : "down"));
  }
  return fmt::format("{}", fmt::join(parts, " and "));
}

/// The rotation, in the axes of the scan, that takes the offset out of a mounting.
std::string cure_in_words(const Offset& off) {
  const double left = std::abs(off.left_rad) > off.left_limit_rad ? off.left_rad : 0.0;
  const double up = std::abs(off.up_rad) > off.up_limit_rad ? off.up_rad : 0.0;
  const Eigen::Vector3d seen(std::cos(up) * std::cos(left), std::cos(up) * std::sin(left), std::sin(up));
  const Eigen::Vector3d normal = seen.cross(Eigen::Vector3d::UnitX());
  const double angle_rad = std::atan2(normal.norm(), seen.x());
  const Eigen::Vector3d axis = off.axes * normal.normalized();
  return fmt::format("rotating its mounting by {:.1f} degrees about ({:.2f}, {:.2f}, {:.2f}) in the axes of the scan",
                     angle_rad / kDegree, axis.x(), axis.y(), axis.z());
}

std::string sensor_in_words(const std::vector<RigLook>& rig_looks, const Judgement& judgement, std::size_t k,
                            const std::vector<Eigen::Isometry3d>& mountings) {
  const Offset off = offset(rig_looks, judgement.leader, k, {});
  const std::vector<std::string> meant = off.angle_rad() > kMixedUp_rad
                                             ? explanations(rig_looks, judgement.leader, k, mountings)
                                             : std::vector<std::string>{};
  return fmt::format("sensor {} moves {} by its Doppler, {} would make it agree", k, offset_in_words(off),
                     meant.empty() ? cure_in_words(off) : fmt::format("{}", fmt::join(meant, ", or ")));
}

void add_numbers(const std::vector<RigLook>& rig_looks, const Judgement& judgement, std::size_t sensors,
                 Finding& finding) {
  finding.evidence = {{"sensors", static_cast<double>(sensors)},
                      {"looks", static_cast<double>(rig_looks.size())},
                      {"compared_with_sensor", static_cast<double>(judgement.leader)}};
  for (std::size_t k = 0; k < sensors; ++k) {
    const Offset off = k != judgement.leader ? offset(rig_looks, judgement.leader, k, {}) : Offset{};
    if (off.is_known) {
      const auto add = [&](const char* name, double angle_rad) {
        finding.evidence.emplace_back(fmt::format("sensor_{}_{}_deg", k, name), angle_rad / kDegree);
      };
      add("left", off.left_rad);
      add("left_limit", off.left_limit_rad);
      add("up", off.up_rad);
      add("up_limit", off.up_limit_rad);
    }
  }
}

/// Nothing contradicts: how much that says.
void describe_agreement(const std::vector<RigLook>& rig_looks, const Judgement& judgement, std::size_t sensors,
                        Finding& finding) {
  std::vector<std::string> vague;
  double limit_rad = 0.0;
  double up_limit_rad = 0.0;
  for (std::size_t k = 0; k < sensors; ++k) {
    if (k == judgement.leader) {
      continue;
    }
    const Offset off = offset(rig_looks, judgement.leader, k, {});
    limit_rad = std::max(limit_rad, off.left_limit_rad);
    up_limit_rad = std::max(up_limit_rad, off.up_limit_rad);
    if (!off.is_known || off.left_limit_rad > kWellKnown_rad) {
      const bool is_open = !off.is_known || off.left_limit_rad > std::numbers::pi;
      vague.push_back(fmt::format("sensor {} by {}", k,
                                  is_open ? "any angle" : fmt::format("{:.0f} degrees", off.left_limit_rad / kDegree)));
    }
  }
  if (!vague.empty()) {
    finding.sentence =
        fmt::format("nothing contradicts the mountings, but not much would: next to sensor {}, {} could be off unseen",
                    judgement.leader, fmt::join(vague, ", "));
    return;
  }
  finding.verdict = Verdict::kOk;
  finding.sentence = fmt::format(
      "by their Doppler all {} sensors move as their mountings have it: from {:.1f} degrees to the side or {:.1f} up "
      "or "
      "down it would show, a rotation about the direction of travel would not",
      sensors, limit_rad / kDegree, up_limit_rad / kDegree);
}

void describe_contradiction(const std::vector<RigLook>& rig_looks, const Judgement& judgement,
                            const std::vector<Eigen::Isometry3d>& mountings, Finding& finding) {
  double worst_rad = 0.0;
  for (const std::size_t k : judgement.wrong) {
    worst_rad = std::max(worst_rad, offset(rig_looks, judgement.leader, k, {}).angle_rad());
  }
  finding.verdict = worst_rad > kMixedUp_rad ? Verdict::kWrong : Verdict::kSuspicious;
  if (judgement.is_decided) {
    std::vector<std::string> parts;
    for (const std::size_t k : judgement.wrong) {
      parts.push_back(sensor_in_words(rig_looks, judgement, k, mountings));
    }
    finding.sentence = fmt::format("the mountings contradict the data: next to sensor {}, {}", judgement.leader,
                                   fmt::join(parts, "; "));
  } else {
    finding.sentence = fmt::format(
        "the mountings contradict the data: by their Doppler sensors {} and {} move {:.1f} degrees apart, and nothing "
        "shows which of them is right",
        judgement.leader, fmt::join(judgement.wrong, ", "), worst_rad / kDegree);
  }
  if (worst_rad > kMixedUp_rad && (judgement.wrong.size() > 1 || !judgement.is_decided)) {
    const std::string common = common_explanation(rig_looks, mountings);
    finding.sentence += common.empty() ? "" : fmt::format("; all agree if each mounting is replaced by {}", common);
  }
  finding.sentence += "; correct the calibration of the recording";
}

}  // namespace

Finding rig_mountings(const Evidence& evidence) {
  Finding finding{Question::kRigMountings, Verdict::kCannotTell, ""};
  const auto of_rig =
      std::ranges::find_if(evidence.looks, [](const ScanLook& look) { return look.mountings.size() > 1; });
  if (of_rig == evidence.looks.end()) {
    finding.verdict = Verdict::kOk;
    finding.sentence = "one sensor: there are no mountings to compare";
    return finding;
  }
  if (of_rig->sensors.empty() || !evidence.is_in_metres()) {
    finding.sentence = of_rig->sensors.empty() ? "a compensated Doppler does not show how its sensors move"
                                               : "columns or units are not those of points and Doppler";
    return finding;
  }
  const std::size_t sensors = of_rig->mountings.size();
  const std::vector<RigLook> rig_looks = rig_looks_of(evidence, sensors);
  if (rig_looks.empty()) {
    finding.sentence = "the sensors do not move, or too slowly to compare their mountings";
    return finding;
  }
  const Judgement judgement = judge(rig_looks, sensors);
  add_numbers(rig_looks, judgement, sensors, finding);
  if (judgement.wrong.empty()) {
    describe_agreement(rig_looks, judgement, sensors, finding);
  } else {
    describe_contradiction(rig_looks, judgement, of_rig->mountings, finding);
  }
  return finding;
}

}  // namespace dynamic_icp::diagnosis
