// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/rig_hypotheses.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/method/base/se3.hpp"

namespace dynamic_icp::diagnosis {
namespace {

using Rotation = Eigen::Matrix3d;

constexpr double kFits_rad = 10.0 * std::numbers::pi / 180.0;
constexpr double kFitsShare = 0.25;  // of the offset without the hypothesis

/// A mistake: what the rotation of the mounting is meant to be where this one is stated.
struct Mistake {
  std::string_view meant;
  Rotation (*rotation)(const Rotation& stated);
};

Rotation about_own_z(const Rotation& stated, double angle_rad) {
  return stated * exp_so3(angle_rad * Eigen::Vector3d::UnitZ());
}

constexpr double kQuarter_rad = 0.5 * std::numbers::pi;

constexpr std::array<Mistake, 7> kMistakes = {{
    {"its inverse", [](const Rotation& stated) { return Rotation(stated.transpose()); }},
    {"its quaternion in the order x, y, z, w",
     [](const Rotation& stated) {
       const Eigen::Quaterniond q(stated);
       return Rotation(Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()));
     }},
    {"its quaternion in the order w, x, y, z",
     [](const Rotation& stated) {
       const Eigen::Quaterniond q(stated);
       return Rotation(Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()));
     }},
    {"its angles in radians, not in degrees",
     [](const Rotation& stated) { return exp_so3(180.0 / std::numbers::pi * log_so3(stated)); }},
    {"a quarter turn to the left about its own z axis",
     [](const Rotation& stated) { return about_own_z(stated, kQuarter_rad); }},
    {"a quarter turn to the right about its own z axis",
     [](const Rotation& stated) { return about_own_z(stated, -kQuarter_rad); }},
    {"half a turn about its own z axis",
     [](const Rotation& stated) { return about_own_z(stated, 2.0 * kQuarter_rad); }},
}};

/// The Doppler does not show a sensor turned upside down about the direction of travel; nobody means that.
bool turns_over(const Rotation& stated, const Rotation& meant) { return stated(2, 2) > 0.0 && meant(2, 2) < 0.0; }

bool fits(const Offset& offset, double without_rad) {
  return !offset.contradicts() && offset.angle_rad() < std::min(kFits_rad, kFitsShare * without_rad);
}

}  // namespace

std::vector<std::string> explanations(const std::vector<RigLook>& rig_looks, std::size_t right, std::size_t wrong,
                                      std::span<const Eigen::Isometry3d> mountings) {
  const double without_rad = offset(rig_looks, right, wrong, {}).angle_rad();
  const Rotation stated = mountings[wrong].linear();
  const auto fits_as = [&](const Rotation& meant) {
    Remounting remounting(mountings.size(), Rotation::Identity());
    remounting[wrong] = meant * stated.transpose();
    return !turns_over(stated, meant) && fits(offset(rig_looks, right, wrong, remounting), without_rad);
  };
  std::vector<std::string> words;
  for (const Mistake& mistake : kMistakes) {
    if (fits_as(mistake.rotation(stated))) {
      words.emplace_back(mistake.meant);
    }
  }
  for (std::size_t k = 0; k < mountings.size(); ++k) {
    if (k != wrong && fits_as(mountings[k].linear())) {
      words.push_back(fmt::format("the mounting of sensor {}", k));
    }
  }
  return words;
}

std::string common_explanation(const std::vector<RigLook>& rig_looks, std::span<const Eigen::Isometry3d> mountings) {
  for (const Mistake& mistake : kMistakes) {
    Remounting remounting;
    bool all_fit = true;
    for (const Eigen::Isometry3d& T_scan_sensor : mountings) {
      const Rotation meant = mistake.rotation(T_scan_sensor.linear());
      remounting.push_back(meant * T_scan_sensor.linear().transpose());
      all_fit = all_fit && !turns_over(T_scan_sensor.linear(), meant);
    }
    for (std::size_t i = 0; i < mountings.size(); ++i) {
      for (std::size_t k = i + 1; k <= mountings.size(); ++k) {  // the last one: the direction of travel
        const Offset left = offset(rig_looks, i, k, remounting);
        all_fit = all_fit && !left.contradicts() && (!left.is_known || left.angle_rad() < kFits_rad);
      }
    }
    if (all_fit) {
      return std::string(mistake.meant);
    }
  }
  return {};
}

}  // namespace dynamic_icp::diagnosis
