// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/checkpoint.hpp"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestShare = 0.01;  // of the time of a run, for its checkpoints

void archive_checkpoint(StateArchive& archive, Checkpoint& checkpoint) {
  archive(checkpoint.identity, checkpoint.command, checkpoint.next, checkpoint.last_scan, checkpoint.odometry,
          checkpoint.results);
}

/// "/configuration/window.knot_spacing_s" as users know it.
std::string setting_name(std::string pointer) {
  constexpr std::string_view kConfiguration = "/configuration/";
  pointer.erase(0, pointer.starts_with(kConfiguration) ? kConfiguration.size() : 1);
  std::replace(pointer.begin(), pointer.end(), '/', '.');
  return pointer;
}

}  // namespace

std::uint64_t checksum(const RawScan& scan) {
  RawScan copy = scan;
  StateArchive archive;
  archive(copy.stamp, copy.points, copy.doppler, copy.times, copy.directions, copy.channels.sensor, copy.channels.line,
          copy.channels.face, copy.channels.intensity, copy.channels.return_number, copy.is_unusable, copy.mountings,
          copy.doppler_kind);
  const std::string bytes = archive.take();
  std::uint64_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  return sum;
}

void write_checkpoint(const fs::path& folder, Checkpoint& checkpoint) {
  StateArchive archive;
  archive_checkpoint(archive, checkpoint);
  formats::write_whole_file(folder / kCheckpointFile, archive.take());
}

Checkpoint read_checkpoint(const fs::path& folder) {
  const fs::path path = folder / kCheckpointFile;
  const std::string bytes = formats::read_whole_file(path);
  try {
    Checkpoint checkpoint;
    StateArchive archive(bytes);
    archive_checkpoint(archive, checkpoint);
    archive.end();
    return checkpoint;
  } catch (const DataError& error) {
    throw DataError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

std::optional<std::string> difference(const std::string& identity_then, const std::string& identity_now) {
  using Json = nlohmann::ordered_json;
  // What is nested deeper than any settings are is left out: the library walks through values by recursion.
  const auto is_shallow = [](int depth, Json::parse_event_t, Json&) { return depth <= kMaxDepthOfSettings; };
  const Json whole_then = Json::parse(identity_then, is_shallow);
  const Json whole_now = Json::parse(identity_now, is_shallow);
  for (const auto& [name, part] : whole_now.items()) {
    if (!whole_then.contains(name)) {
      continue;
    }
    const Json then = Json{{name, whole_then[name]}}.flatten();
    const Json now = Json{{name, part}}.flatten();
    for (const Json* settings : {&now, &then}) {
      for (const auto& [setting, value] : settings->items()) {
        const std::string text_then = then.value(setting, Json()).dump();
        const std::string text_now = now.value(setting, Json()).dump();
        if (text_then != text_now) {
          return fmt::format("{} was {} and is {} now", setting_name(setting), text_then, text_now);
        }
      }
    }
  }
  return std::nullopt;
}

bool CheckpointTimer::is_due() const {
  const auto passed = std::chrono::duration<double>(Clock::now() - last_).count();
  const auto cost_s = std::chrono::duration<double>(cost_).count();
  return interval_s_ == 0.0 || passed >= std::max(interval_s_, cost_s / kLargestShare);
}

}  // namespace dynamic_icp::runs
