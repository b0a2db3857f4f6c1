// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/truth_search.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kNear_s = 0.2;

bool is_candidate(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  return name == "ref_poses.txt" || name == "ground_truth.txt" || name == "gt.txt" || name == "poses.txt" ||
         (name.ends_with("_gt.txt") && name.front() != '.');
}

bool is_near(const formats::Trajectory& poses, Stamp stamp) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const formats::StampedPose& pose, Stamp s) { return pose.stamp < s; });
  return (after != poses.end() && seconds_between(stamp, after->stamp) <= kNear_s) ||
         (after != poses.begin() && seconds_between(std::prev(after)->stamp, stamp) <= kNear_s);
}

/// Why the poses do not belong to the scans; empty when they may.
std::string misfit(const formats::Trajectory& poses, const std::vector<Stamp>& stamps, bool stamps_are_indices) {
  if (stamps_are_indices) {
    return poses.size() == stamps.size() ? "" : fmt::format("{} poses for {} scans", poses.size(), stamps.size());
  }
  const auto near = static_cast<std::size_t>(
      std::count_if(stamps.begin(), stamps.end(), [&](Stamp stamp) { return is_near(poses, stamp); }));
  return 2 * near >= stamps.size()
             ? ""
             : fmt::format("{} of {} scans are within {} s of one of its poses", near, stamps.size(), kNear_s);
}

/// The trajectories of a folder that fit; why others do not is added to the assumptions.
std::vector<Truth> fitting_in(const fs::path& folder, const std::vector<Stamp>& stamps, bool stamps_are_indices,
                              std::vector<std::string>& assumptions) {
  std::vector<Truth> fitting;
  for (const fs::path& path : entries_of(folder, is_candidate)) {
    try {
      formats::Trajectory poses = formats::read_tum(path).trajectory;
      const std::string reason = misfit(poses, stamps, stamps_are_indices);
      if (reason.empty()) {
        fitting.push_back({std::move(poses), path});
      } else {
        assumptions.push_back(fmt::format("{}: is not used as ground truth: {}", path.string(), reason));
      }
    } catch (const DataError& error) {
      assumptions.push_back(fmt::format("not used as ground truth: {}", error.what()));
    }
  }
  return fitting;
}

}  // namespace

Truth search_truth(const fs::path& folder, const std::vector<Stamp>& stamps, bool stamps_are_indices,
                   std::vector<std::string>& assumptions) {
  for (const fs::path& place : {folder, named_path(folder).parent_path()}) {
    std::vector<Truth> fitting = fitting_in(place, stamps, stamps_are_indices, assumptions);
    if (fitting.size() > 1) {
      std::string names;
      for (const Truth& truth : fitting) {
        names += fmt::format(" {}", truth.file.string());
      }
      assumptions.push_back(fmt::format("no ground truth is taken: several files fit, name one of them:{}", names));
      return {};
    }
    if (fitting.size() == 1) {
      assumptions.push_back(fmt::format("ground truth is taken from {}", fitting.front().file.string()));
      return std::move(fitting.front());
    }
  }
  return {};
}

}  // namespace dynamic_icp::datasets
