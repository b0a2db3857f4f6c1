// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/files_beside.hpp"

#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/recording/formats/kitti_write.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

/// The map to be made, if one is asked for. What cannot be is refused before anything is computed.
std::optional<MapWriter> make_map(const RunSettings& settings) {
  if (!settings.map_file) {
    return std::nullopt;
  }
  check_map_file(*settings.map_file);
  if (settings.method != "dynamic-icp") {
    throw UsageError(fmt::format("only dynamic-icp separates static from moving points, {} does not: it makes no map",
                                 settings.method));
  }
  return MapWriter(settings.map_voxel_m);
}

/// Files of other kinds would be taken for what they are not, and must not have the name of a result.
void check_ending(const std::optional<fs::path>& file, const char* ending, const char* what) {
  if (file && file->extension() != ending) {
    throw UsageError(
        fmt::format("'{}' cannot be {}: expected a file name that ends in {}", file->string(), what, ending));
  }
}

/// The layout that goes with an MCAP file, unless there is one, which its owner may have changed.
fs::path layout_beside(const fs::path& mcap_file) {
  const fs::path layout = mcap_file.parent_path() / kFoxgloveLayoutFile;
  std::error_code ignored;
  return mcap_file.empty() || fs::exists(layout, ignored) ? fs::path() : layout;
}

}  // namespace

FilesBeside::FilesBeside(const RunSettings& settings, Fail fail)
    : settings_(settings), fail_(std::move(fail)), map_(make_map(settings)) {
  check_ending(settings.mcap_file, ".mcap", "an MCAP file");
  check_ending(settings.kitti_file, ".txt", "a file of KITTI poses");
}

void FilesBeside::refuse(const std::vector<fs::path>& inputs) const {
  for (const std::optional<fs::path>* file : {&settings_.mcap_file, &settings_.kitti_file}) {
    for (const fs::path& input : inputs) {
      std::error_code missing;
      if (*file && !input.empty() && fs::equivalent(**file, input, missing)) {
        throw UsageError(fmt::format("'{}' is an input of the run; choose another name", (*file)->string()));
      }
    }
  }
}

void FilesBeside::place(const formats::OutputFolder& output) {
  const auto destination = [&](const std::optional<fs::path>& file, const char* what) {
    return file ? map_destination(*file, settings_.output, output.path(), what) : fs::path();
  };
  map_file_ = destination(settings_.map_file, "map");
  mcap_file_ = destination(settings_.mcap_file, "MCAP file");
  kitti_file_ = destination(settings_.kitti_file, "file of KITTI poses");
}

FilesInRun FilesBeside::in_run(const formats::OutputFolder& output) const {
  const auto in_run = [&](const fs::path& file) {
    return formats::lies_in(file, output.path()) ? file.lexically_relative(output.path()) : fs::path();
  };
  return {.map = in_run(map_file_),
          .mcap = in_run(mcap_file_),
          .layout = in_run(layout_beside(mcap_file_)),
          .kitti = in_run(kitti_file_)};
}

void FilesBeside::open(const formats::Trajectory& ground_truth, const RunMessagesSettings& messages) {
  if (!mcap_file_.empty()) {
    recorder_.emplace(mcap_file_, ground_truth, messages);
  }
}

void FilesBeside::add(const RawScan& scan, const odometry::Frame& frame, double latency_ms) {
  add_to_map(frame);
  record(scan, frame, latency_ms);
}

void FilesBeside::add_to_map(const odometry::Frame& frame) {
  if (!map_) {
    return;
  }
  try {
    map_->add(frame);
  } catch (const std::exception& error) {
    fail_(fmt::format("no map: {}", error.what()));
    map_.reset();
  }
}

void FilesBeside::record(const RawScan& scan, const odometry::Frame& frame, double latency_ms) {
  if (!recorder_) {
    return;
  }
  try {
    recorder_->add(scan, frame, latency_ms);
  } catch (const std::exception& error) {
    fail_(fmt::format("no MCAP file: {}", error.what()));
    recorder_.reset();
  }
}

void FilesBeside::describe(RunResult& result) const {
  result.map_points = map_ ? std::optional(map_->size()) : std::nullopt;
  result.has_mcap = recorder_.has_value();
  result.has_kitti = !kitti_file_.empty();
}

void FilesBeside::write(const formats::Trajectory& trajectory, const formats::OutputFolder& output, RunResult& result) {
  write_map(output, result);
  write_mcap(output, result);
  write_kitti(trajectory, output, result);
}

void FilesBeside::write_map(const formats::OutputFolder& output, RunResult& result) {
  try {
    if (map_) {
      map_->write(map_file_);
    }
  } catch (const std::exception& error) {
    fail_("no map: " + output.in_final_names(error.what()));
    result.map_points.reset();
  }
}

void FilesBeside::write_mcap(const formats::OutputFolder& output, RunResult& result) {
  try {
    if (recorder_) {
      recorder_->commit();
      if (const fs::path layout = layout_beside(mcap_file_); !layout.empty()) {
        formats::write_whole_file(layout, foxglove_layout());
      }
    }
  } catch (const std::exception& error) {
    fail_("no MCAP file: " + output.in_final_names(error.what()));
    result.has_mcap = false;
  }
  recorder_.reset();
}

void FilesBeside::write_kitti(const formats::Trajectory& trajectory, const formats::OutputFolder& output,
                              RunResult& result) {
  try {
    if (!kitti_file_.empty()) {
      formats::write_kitti(kitti_file_, trajectory);
    }
  } catch (const std::exception& error) {
    fail_("no KITTI poses: " + output.in_final_names(error.what()));
    result.has_kitti = false;
  }
}

void FilesBeside::state(StateArchive& archive) {
  bool has_map = map_.has_value();
  archive(has_map);
  if (!has_map || !map_) {
    map_.reset();
    return;
  }
  archive(*map_);
}

void FilesBeside::begin_anew() { map_ = make_map(settings_); }

}  // namespace dynamic_icp::runs
