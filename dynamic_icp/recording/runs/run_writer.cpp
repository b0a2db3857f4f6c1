// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_writer.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/recording/evaluation/statistics.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/runs/frame_json.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"

namespace dynamic_icp::runs {
namespace {

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) {
    return std::nullopt;
  }
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void count_reason(std::vector<std::pair<odometry::FrameStatus, std::size_t>>& counts, odometry::FrameStatus reason) {
  const auto known = std::find_if(counts.begin(), counts.end(), [&](const auto& row) { return row.first == reason; });
  if (known == counts.end()) {
    counts.emplace_back(reason, 1);
  } else {
    ++known->second;
  }
}

}  // namespace

RunWriter::RunWriter(const std::filesystem::path& folder, bool save_labels)
    : folder_(folder),
      save_labels_(save_labels),
      frames_file_(folder / "frames.jsonl"),
      objects_file_(folder / "objects.jsonl") {
  if (save_labels_) {
    formats::make_folder(folder_ / "labels");
  }
}

RunWriter::RunWriter(const std::filesystem::path& folder, bool save_labels, Lengths lengths)
    : folder_(folder),
      save_labels_(save_labels),
      frames_file_(formats::OutputFile::resume(folder / "frames.jsonl", lengths.frames)),
      objects_file_(formats::OutputFile::resume(folder / "objects.jsonl", lengths.objects)) {}

RunWriter::RunWriter(const std::filesystem::path& folder, bool save_labels, std::size_t next, StateArchive& state)
    : RunWriter(folder, save_labels, lengths_in(state)) {
  counts_state(state);
  if (save_labels_) {
    check_labels(next);
  }
}

RunWriter::Lengths RunWriter::lengths_in(StateArchive& archive) {
  Lengths lengths;
  archive(lengths.frames, lengths.objects);
  return lengths;
}

/// Those of the scans that are done are there, and no others.
void RunWriter::check_labels(std::size_t next) const {
  for (std::size_t index = next - trajectory_.size(); index < next; ++index) {
    if (!std::filesystem::exists(labels_file(folder_, index))) {
      throw DataError(fmt::format("{}: no such file", labels_file(folder_, index).string()));
    }
  }
  std::vector<std::filesystem::path> later;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "labels")) {
    const auto number = parse_number<std::size_t>(entry.path().stem().string());
    if (!number || *number > next) {
      later.push_back(entry.path());
    }
  }
  for (const std::filesystem::path& file : later) {
    std::filesystem::remove(file);
  }
}

void RunWriter::save(StateArchive& archive) {
  Lengths lengths{frames_file_.synchronise(), objects_file_.synchronise()};
  archive(lengths.frames, lengths.objects);
  counts_state(archive);
}

void RunWriter::counts_state(StateArchive& archive) {
  archive.each(trajectory_, [&](formats::StampedPose& pose) { archive(pose.stamp, pose.T_world_sensor); });
  archive.each(stated_, [&](evaluation::StatedMotion& one) { archive(one.covariance, one.ok, one.skipped); });
  archive(total_ms_, iterations_, dynamic_ratio_, clustered_ratio_, refined_ratio_, pairs_, converged_, verdicts_,
          reasons_, lost_);
}

void RunWriter::add(std::size_t index, const odometry::Frame& frame) {
  frames_file_.write(frame_line(index, frame) + "\n");
  objects_file_.write(objects_line(index, frame) + "\n");
  if (save_labels_) {
    formats::write_values<std::int32_t>(labels_file(folder_, index), frame.labels);
  }
  trajectory_.push_back({frame.stamp, frame.T_world_sensor});
  stated_.push_back({frame.alignment.covariance, verdict(frame.status) == "ok", odometry::is_skipped(frame.status)});
  total_ms_.push_back(frame.times.total_ms);
  const auto word = std::ranges::find(odometry::kVerdicts, verdict(frame.status));
  ++verdicts_.at(static_cast<std::size_t>(word - odometry::kVerdicts.begin()));
  count_reason(reasons_, frame.status);
  lost_.add(frame);
  if (trajectory_.size() > 1) {
    ++pairs_;
    converged_ += odometry::converged(frame.status) ? 1 : 0;
  }
  if (frame.alignment.status != registration::AlignStatus::kNotRun) {
    iterations_.push_back(frame.alignment.iterations);
  }
  const auto ratio = [](std::vector<double>& ratios, std::size_t part, std::size_t whole) {
    if (whole > 0) {
      ratios.push_back(static_cast<double>(part) / static_cast<double>(whole));
    }
  };
  ratio(dynamic_ratio_, frame.dynamic_candidates, frame.points_used);
  ratio(clustered_ratio_, frame.dynamic_clustered, frame.dynamic_candidates);
  ratio(refined_ratio_, frame.dynamic_refined, frame.dynamic_clustered);
}

RunSummary RunWriter::finish(const std::string& method, const formats::Trajectory& ground_truth,
                             const std::vector<std::string>& assumptions, bool stopped) {
  RunSummary summary;
  summary.stopped = stopped;
  summary.assumptions = assumptions;
  summary.method = method;
  summary.frames = trajectory_.size();
  if (!ground_truth.empty() && !trajectory_.empty()) {
    try {
      summary.accuracy = evaluation::evaluate_run(trajectory_, ground_truth, stated_);
    } catch (const DataError& error) {  // a comparison that fails is no reason to lose what was computed
      summary.no_accuracy = error.what();
    }
  }
  summary.mean_iterations = mean(iterations_);
  if (pairs_ > 0) {
    summary.convergence_rate = static_cast<double>(converged_) / static_cast<double>(pairs_);
  }
  if (const auto times = evaluation::summarize(total_ms_)) {
    summary.ms_mean = times->mean;
    summary.ms_median = times->median;
    summary.ms_p95 = times->p95;
    if (times->mean > 0.0) {
      summary.fps = 1000.0 / times->mean;
    }
  }
  summary.dynamic_ratio_mean = mean(dynamic_ratio_);
  if (!dynamic_ratio_.empty()) {
    summary.dynamic_ratio_max = *std::max_element(dynamic_ratio_.begin(), dynamic_ratio_.end());
  }
  summary.clustered_ratio_mean = mean(clustered_ratio_);
  summary.refined_ratio_mean = mean(refined_ratio_);
  summary.verdicts = verdicts_;
  summary.reasons = reasons_;
  summary.failure = lost_.failure().value_or("");

  frames_file_.close();
  objects_file_.close();
  formats::write_tum(folder_ / "trajectory.tum", trajectory_);
  formats::write_whole_file(folder_ / "summary.json", summary_json(summary) + "\n");
  return summary;
}

}  // namespace dynamic_icp::runs
