// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/truth_search.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kNear_s = 0.2;

bool is_candidate(const fs::directory_entry& entry) { return is_truth_name(entry.path()); }

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
      PoseFile file = read_pose_file(path);
      const bool one_for_one = stamps_are_indices || !file.has_stamps;
      const std::string reason = misfit(file.poses, stamps, one_for_one);
      if (reason.empty()) {
        for (std::size_t i = 0; !file.has_stamps && i < stamps.size(); ++i) {
          file.poses[i].stamp = stamps[i];
        }
        fitting.push_back({std::move(file.poses), path});
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

bool is_truth_name(const fs::path& file) {
  const std::string name = file.stem().string();
  const fs::path ending = file.extension();
  const bool is_text = ending == ".txt" || ending == ".csv" || ending == ".tum";
  const bool is_named = name == "ref_poses" || name == "ground_truth" || name == "groundtruth" || name == "gt" ||
                        name == "poses" || name == "gt_poses" || name.ends_with("_gt") || name.ends_with("_poses");
  return is_text && is_named && name.front() != '.';
}

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

Truth take_truth(const fs::path& folder, StampedFiles& scans) {
  std::vector<std::string> said;
  Truth truth = search_truth(folder, scans.stamps, scans.are_indices, said);
  if (scans.are_indices && !truth.poses.empty()) {
    std::transform(truth.poses.begin(), truth.poses.end(), scans.stamps.begin(),
                   [](const formats::StampedPose& pose) { return pose.stamp; });
    scans.assumptions = {"the names of the scans are no times: those of the poses are taken, one for one"};
  }
  scans.assumptions.insert(scans.assumptions.begin(), said.begin(), said.end());
  return truth;
}

}  // namespace dynamic_icp::datasets
