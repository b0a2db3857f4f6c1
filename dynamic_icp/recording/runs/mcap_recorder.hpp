// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "dynamic_icp/recording/bags/mcap_writer.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/run_messages.hpp"

namespace dynamic_icp::runs {

/// The layout that shows the file of an McapRecorder well arranged in Foxglove and Lichtblick:
/// docs/foxglove_layout.json.
std::string_view foxglove_layout();
inline constexpr const char* kFoxgloveLayoutFile = "foxglove_layout.json";

/// Writes the messages of a run (run_messages.hpp) as an MCAP file that appears whole or not at all.
class McapRecorder {
 public:
  /// `truth` may be empty and must outlive the object. Throws DataError naming the file when it cannot be created.
  McapRecorder(const std::filesystem::path& file, const formats::Trajectory& truth, RunMessagesSettings settings);

  /// Throws DataError when the file cannot be written, or the stamp is before 1970.
  void add(const RawScan& raw, const odometry::Frame& frame, double latency_ms) {
    messages_.add(raw, frame, latency_ms);
  }

  /// Writes what is left and gives the file its name.
  void commit();

 private:
  formats::StagedFile file_;
  bags::McapWriter writer_;
  std::vector<std::uint16_t> channels_;  ///< by topic
  RunMessages messages_;
};

}  // namespace dynamic_icp::runs
