// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_writer.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/recording/evaluation/statistics.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/runs/frame_json.hpp"
#include "dynamic_icp/recording/runs/lost_scans.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

namespace dynamic_icp::runs {
namespace {

/// Mean and largest of numbers that come one after the other.
class RunningMean {
 public:
  void add(double value) {
    sum_ += value;
    most_ = count_ == 0 ? value : std::max(most_, value);
    ++count_;
  }
  void add_share(std::size_t part, std::size_t whole) {
    if (whole > 0) {
      add(static_cast<double>(part) / static_cast<double>(whole));
    }
  }
  [[nodiscard]] std::optional<double> mean() const {
    return count_ > 0 ? std::optional(sum_ / static_cast<double>(count_)) : std::nullopt;
  }
  [[nodiscard]] std::optional<double> most() const { return count_ > 0 ? std::optional(most_) : std::nullopt; }

 private:
  double sum_ = 0.0;
  double most_ = 0.0;
  std::size_t count_ = 0;
};

void count_reason(std::vector<std::pair<odometry::FrameStatus, std::size_t>>& counts, odometry::FrameStatus reason) {
  const auto known = std::find_if(counts.begin(), counts.end(), [&](const auto& row) { return row.first == reason; });
  if (known == counts.end()) {
    counts.emplace_back(reason, 1);
  } else {
    ++known->second;
  }
}

/// What the summary says of all scans, from their records one by one.
class ScanTotals {
 public:
  void add(const ScanRecord& scan) {
    const auto word = std::ranges::find(odometry::kVerdicts, verdict(scan.status));
    ++verdicts_.at(static_cast<std::size_t>(word - odometry::kVerdicts.begin()));
    count_reason(reasons_, scan.status);
    lost_.add(scan);
    if (scans_ > 0) {
      converged_ += odometry::converged(scan.status) ? 1 : 0;
    }
    ++scans_;
    if (scan.is_aligned) {
      iterations_.add(scan.iterations);
    }
    total_ms_.push_back(scan.total_ms);
    dynamic_ratio_.add_share(scan.dynamic_candidates, scan.points_used);
    clustered_ratio_.add_share(scan.dynamic_clustered, scan.dynamic_candidates);
    refined_ratio_.add_share(scan.dynamic_refined, scan.dynamic_clustered);
  }

  void write(RunSummary& summary) const {
    summary.frames = scans_;
    summary.mean_iterations = iterations_.mean();
    if (scans_ > 1) {
      summary.convergence_rate = static_cast<double>(converged_) / static_cast<double>(scans_ - 1);
    }
    if (const auto times = evaluation::summarize(total_ms_)) {
      summary.ms_mean = times->mean;
      summary.ms_median = times->median;
      summary.ms_p95 = times->p95;
      if (times->mean > 0.0) {
        summary.fps = 1000.0 / times->mean;
      }
    }
    summary.dynamic_ratio_mean = dynamic_ratio_.mean();
    summary.dynamic_ratio_max = dynamic_ratio_.most();
    summary.clustered_ratio_mean = clustered_ratio_.mean();
    summary.refined_ratio_mean = refined_ratio_.mean();
    summary.verdicts = verdicts_;
    summary.reasons = reasons_;
    summary.failure = lost_.failure().value_or("");
  }

 private:
  std::size_t scans_ = 0;
  std::size_t converged_ = 0;  ///< of all but the first
  std::vector<double> total_ms_;
  RunningMean iterations_;
  RunningMean dynamic_ratio_;
  RunningMean clustered_ratio_;
  RunningMean refined_ratio_;
  decltype(RunSummary::verdicts) verdicts_{};
  decltype(RunSummary::reasons) reasons_;
  LostScans lost_;
};

}  // namespace

RunWriter::RunWriter(const std::filesystem::path& folder, bool save_labels)
    : folder_(folder),
      save_labels_(save_labels),
      frames_file_(folder / "frames.jsonl"),
      objects_file_(folder / "objects.jsonl"),
      records_file_(folder / kScanRecordsFile) {
  if (save_labels_) {
    formats::make_folder(folder_ / "labels");
  }
}

RunWriter::RunWriter(const std::filesystem::path& folder, bool save_labels, const Written& written)
    : folder_(folder),
      save_labels_(save_labels),
      frames_file_(formats::OutputFile::resume(folder / "frames.jsonl", written.frames)),
      objects_file_(formats::OutputFile::resume(folder / "objects.jsonl", written.objects)),
      records_file_(formats::OutputFile::resume(folder / kScanRecordsFile, record_file_bytes(written.scans))),
      scans_(written.scans) {}

RunWriter::RunWriter(const std::filesystem::path& folder, bool save_labels, std::size_t next, StateArchive& state)
    : RunWriter(folder, save_labels, written_in(state)) {
  check_records();
  if (save_labels_) {
    check_labels(next);
  }
}

RunWriter::Written RunWriter::written_in(StateArchive& archive) {
  Written written;
  archive(written.frames, written.objects, written.scans);
  return written;
}

/// That of each scan is there and whole: the summary is made of them at the end, too late to begin anew.
void RunWriter::check_records() const {
  const std::filesystem::path file = folder_ / kScanRecordsFile;
  const std::size_t there = for_each_record(file, [](const ScanRecord&) {});
  if (there != scans_) {
    throw DataError(fmt::format("{}: has {} records, expected {}", file.string(), there, scans_));
  }
}

/// Those of the scans that are done are there, and no others.
void RunWriter::check_labels(std::size_t next) const {
  for (std::size_t index = next - scans_; index < next; ++index) {
    if (!std::filesystem::exists(labels_file(folder_, index))) {
      throw DataError(fmt::format("{}: no such file", labels_file(folder_, index).string()));
    }
  }
  std::vector<std::filesystem::path> later;
  for (const auto& entry : formats::entries_in(folder_ / "labels")) {
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
  Written written{frames_file_.synchronise(), objects_file_.synchronise(), scans_};
  records_file_.synchronise();
  archive(written.frames, written.objects, written.scans);
}

void RunWriter::add(std::size_t index, const odometry::Frame& frame) {
  frames_file_.write(frame_line(index, frame) + "\n");
  objects_file_.write(objects_line(index, frame) + "\n");
  if (save_labels_) {
    formats::write_values<std::int32_t>(labels_file(folder_, index), frame.labels);
  }
  records_file_.write(record_bytes(scan_record(frame)));
  ++scans_;
}

RunSummary RunWriter::finish(const std::string& method, const formats::Trajectory& ground_truth,
                             const std::vector<std::string>& assumptions, bool stopped) {
  frames_file_.close();
  objects_file_.close();
  records_file_.close();
  ScanTotals totals;
  std::vector<evaluation::StatedMotion> stated;  // one per pose
  trajectory_.clear();
  for_each_record(folder_ / kScanRecordsFile, [&](const ScanRecord& scan) {
    totals.add(scan);
    trajectory_.push_back({scan.stamp, scan.T_world_sensor});
    if (!ground_truth.empty()) {
      stated.push_back({scan.covariance, verdict(scan.status) == "ok", odometry::is_skipped(scan.status)});
    }
  });
  RunSummary summary;
  summary.stopped = stopped;
  summary.assumptions = assumptions;
  summary.method = method;
  totals.write(summary);
  if (!ground_truth.empty() && !trajectory_.empty()) {
    try {
      summary.accuracy = evaluation::evaluate_run(trajectory_, ground_truth, stated);
    } catch (const DataError& error) {  // a comparison that fails is no reason to lose what was computed
      summary.no_accuracy = error.what();
    }
  }
  formats::write_tum(folder_ / "trajectory.tum", trajectory_);
  formats::write_whole_file(folder_ / "summary.json", summary_json(summary) + "\n");
  return summary;
}

}  // namespace dynamic_icp::runs
