// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"

#include "testing/wall_drive.hpp"

// For tests of runs that ended early and go on.
namespace dynamic_icp::runs {

/// What ends a run here and now, as an error of no known kind does.
struct Ended {};

inline const std::vector<std::string> kNone = {};

/// JSON without times of computation.
inline nlohmann::json without_times(nlohmann::json value) {
  for (const char* const key : {"ms", "ms_mean", "ms_median", "ms_p95", "fps"}) {
    value.erase(key);
  }
  return value;
}

/// All files in a folder.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const std::filesystem::directory_entry& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) {
      continue;
    }
    const std::string name = entry.path().lexically_relative(folder).string();
    std::string text = formats::read_whole_file(entry.path());
    if (name == "frames.jsonl") {
      std::istringstream lines(text);
      text.clear();
      for (std::string line; std::getline(lines, line);) {
        text += without_times(nlohmann::json::parse(line)).dump() + "\n";
      }
    } else if (name == "summary.json") {
      text = without_times(nlohmann::json::parse(text)).dump();
    }
    files[name] = text;
  }
  return files;
}

/// The names of those that are not the same.
inline std::vector<std::string> differing(const std::map<std::string, std::string>& a,
                                          const std::map<std::string, std::string>& b) {
  std::vector<std::string> names;
  for (const auto* const files : {&a, &b}) {
    for (const auto& [name, content] : *files) {
      if (!a.contains(name) || !b.contains(name) || a.at(name) != b.at(name)) {
        names.push_back(name);
      }
    }
  }
  return names;
}

/// A drive in front of a wall, of six scans, and a run over it that writes all that a run can write.
class ResumedRun : public ::testing::Test {
 protected:
  ResumedRun() {
    report::WallDrive().write(folder_);
    std::filesystem::remove_all(folder_.path() / "run");  // of the hand-made run nothing is wanted
    settings_.output = folder_.path() / "out";
    settings_.threads = 1;
    settings_.save_labels = true;
    settings_.map_file = settings_.output / "maps" / "map.ply";
    settings_.kitti_file = settings_.output / "poses.txt";
    settings_.checkpoint_s = 0.0;
    settings_.command = "run";
    callbacks_.notice = [this](const std::string& text) { notices_.push_back(text); };
  }

  [[nodiscard]] Recording recording() const { return {folder_.path() / "drive", {}}; }

  [[nodiscard]] std::optional<RunResult> run() { return run_recording(recording(), settings_, callbacks_); }

  /// Begins, or goes on, and ends before anything is done with the result of scan `last`.
  void run_until(std::size_t last) {
    RunCallbacks callbacks = callbacks_;
    callbacks.frame = [&](std::size_t index, const odometry::Frame&) {
      if (index == last) {
        throw Ended();
      }
    };
    EXPECT_THROW((void)run_recording(recording(), settings_, callbacks), Ended);
    EXPECT_FALSE(std::filesystem::exists(settings_.output));
  }

  /// The files of a run that nothing ended.
  std::map<std::string, std::string> unbroken() {
    (void)run();
    auto files = files_in(settings_.output);
    std::filesystem::remove_all(settings_.output);
    return files;
  }

  /// The folder that an ended run has left.
  [[nodiscard]] std::filesystem::path left() const {
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder_.path())) {
      if (entry.path().filename().string().starts_with(".out.partial-")) {
        return entry.path();
      }
    }
    return {};
  }

  /// The message of the error that it ends with; empty if it does not.
  std::string refusal() {
    try {
      (void)run();
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  }

  [[nodiscard]] bool was_told(const std::string& words) const {
    return std::any_of(notices_.begin(), notices_.end(),
                       [&](const std::string& text) { return text.find(words) != std::string::npos; });
  }

  TestFolder folder_;
  RunSettings settings_;
  RunCallbacks callbacks_;
  std::vector<std::string> notices_;
};

}  // namespace dynamic_icp::runs
