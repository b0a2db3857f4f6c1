// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_folder.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/checkpoint.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

fs::path file_of_run(const fs::path& folder, const char* name) {
  fs::path path = folder / name;
  if (!fs::exists(path)) {
    throw DataError(fmt::format("{}: no such file; expected the folder of a finished run", path.string()));
  }
  return path;
}

void check_count(const fs::path& file, const char* what, std::size_t count, std::size_t frames) {
  if (count != frames) {
    throw DataError(fmt::format("{}: {} {}, but frames.jsonl holds {} scans; was the run interrupted?", file.string(),
                                count, what, frames));
  }
}

constexpr const char* kPictures[] = {"consistency", "convergence", "doppler_error", "doppler_error_parts",
                                     "dynamics",    "errors",      "scan",          "speed",
                                     "steps",       "timing",      "trajectory"};

/// The files that were asked for beside the results and lie in the folder of the run; none when its run.json cannot be
/// read.
std::vector<std::string> files_asked_for(const fs::path& run_json) {
  std::vector<std::string> files;
  try {
    const Settings about = read_run_json(run_json).about;
    for (const char* key : {"map.file_in_run", "mcap.file_in_run", "mcap.layout_in_run", "kitti.file_in_run"}) {
      if (std::string file = text_of(about, key); !file.empty()) {
        files.push_back(std::move(file));
      }
    }
  } catch (const std::exception&) {
    files.clear();
  }
  return files;
}

std::vector<std::string> run_files(const fs::path& folder) {
  std::vector<std::string> files = {kCheckpointFile,  kScanRecordsFile,  "run.json",      "summary.json",
                                    "trajectory.tum", "frames.jsonl",    "objects.jsonl", "labels/#.bin",
                                    "report.html",    "calibration.yaml"};
  for (const std::string picture : kPictures) {
    files.push_back("plots/" + picture + ".svg");
    files.push_back("plots/" + picture + ".png");
    files.push_back("plots/" + picture + ".pdf");
  }
  files.insert(files.end(), {"plots/worst_object_#.svg", "plots/worst_object_#.png", "plots/worst_object_#.pdf"});
  for (std::string& file : files_asked_for(folder / "run.json")) {
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace

double RunFiles::seconds(std::size_t frame) const {
  return seconds_between(trajectory.front().stamp, trajectory[frame].stamp);
}

bool is_run_folder(const fs::path& folder) {
  std::error_code fault;  // what cannot be entered is none
  return fs::exists(folder / "run.json", fault) && fs::exists(folder / "trajectory.tum", fault);
}

RunFiles read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw DataError(fmt::format("{}: no such folder; expected the folder of a run", folder.string()));
  }
  RunFiles run;
  run.folder = folder;
  RunRecord record = read_run_json(file_of_run(folder, "run.json"));
  run.run = std::move(record.about);
  run.configuration = std::move(record.configuration);
  run.warnings = std::move(record.assumptions);
  run.warnings.insert(run.warnings.end(), record.warnings.begin(), record.warnings.end());
  run.summary = read_summary(file_of_run(folder, "summary.json"));
  run.frames = read_frames(file_of_run(folder, "frames.jsonl"));
  const fs::path objects = file_of_run(folder, "objects.jsonl");
  for (ObjectsRow& row : read_objects(objects)) {
    run.objects.push_back(std::move(row.objects));
  }
  check_count(objects, "lines", run.objects.size(), run.frames.size());
  const fs::path trajectory = file_of_run(folder, "trajectory.tum");
  if (!run.frames.empty() || fs::file_size(trajectory) > 0) {
    run.trajectory = formats::read_tum(trajectory).trajectory;
  }
  check_count(trajectory, "poses", run.trajectory.size(), run.frames.size());
  return run;
}

fs::path labels_file(const fs::path& folder, std::size_t index) {
  return folder / "labels" / fmt::format("{:05}.bin", index + 1);
}

bool lacks_labels(const RunFiles& run, std::size_t frame) {
  return fs::exists(run.folder / "labels") && !fs::exists(labels_file(run.folder, run.frames[frame].index));
}

std::optional<std::vector<std::int32_t>> read_labels(const fs::path& folder, std::size_t index,
                                                     std::optional<std::size_t> points) {
  const fs::path path = labels_file(folder, index);
  if (!fs::exists(path)) {
    return std::nullopt;
  }
  const std::string bytes = formats::read_whole_file(path);
  if (bytes.size() % 4 != 0) {
    throw DataError(fmt::format("{}: {} bytes, expected int32 numbers", path.string(), bytes.size()));
  }
  std::vector<std::int32_t> labels(bytes.size() / 4);
  if (points && labels.size() != *points) {
    throw DataError(fmt::format("{}: {} bytes, expected {}: int32 for each of the {} points of the scan", path.string(),
                                bytes.size(), 4 * *points, *points));
  }
  for (std::size_t k = 0; k < labels.size(); ++k) {
    labels[k] = formats::value_at<std::int32_t>(bytes, 4 * k);
  }
  return labels;
}

std::optional<std::vector<std::int32_t>> read_labels(const RunFiles& run, std::size_t frame, std::size_t points) {
  return read_labels(run.folder, run.frames[frame].index, points);
}

formats::ResultKind run_result() { return {"run.json", run_files, kCheckpointFile}; }

}  // namespace dynamic_icp::runs
