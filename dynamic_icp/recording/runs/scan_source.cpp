// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/scan_source.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::runs {
namespace {

constexpr std::size_t kScansToCheck = 10;            // of a recording that grows, before the first is processed
constexpr std::chrono::milliseconds kAskAgain{100};  // whether to stop, while scans are waited for

}  // namespace

ScanSource::ScanSource(const Recording& recording, const RunSettings& settings, Stop stop, Warn warn)
    : recording_(recording),
      settings_(settings),
      stop_(std::move(stop)),
      warn_(std::move(warn)),
      dataset_(open()),
      first_scans_(datasets::select_scans(*dataset_, settings.start, scans_to_check())),
      scans_(first_scans_) {
  if (grows()) {  // what was there is known; what comes is not
    scans_.end = settings.max_frames ? scans_.begin + *settings.max_frames : std::numeric_limits<std::size_t>::max();
  }
}

/// The most, before the first is processed; of a recording that grows as many whenever it is looked at.
std::optional<std::size_t> ScanSource::scans_to_check() const {
  return settings_.follow ? std::min(kScansToCheck, settings_.max_frames.value_or(kScansToCheck))
                          : settings_.max_frames;
}

std::unique_ptr<datasets::Dataset> ScanSource::open() {
  if (!settings_.follow) {
    return datasets::open_input(recording_.path, recording_.settings);
  }
  datasets::FirstScans first{.begin = settings_.start, .count = *scans_to_check()};
  if (settings_.follow_timeout_s) {
    first.longest_silence = std::chrono::duration<double>(*settings_.follow_timeout_s);
  }
  std::unique_ptr<datasets::FollowedDataset> followed =
      datasets::follow_input(recording_.path, recording_.settings, first, [this] { return stop_ && stop_(); });
  if (!followed) {
    throw DataError(fmt::format("{}: stopped before its first {} scans had come", recording_.path.string(),
                                first.begin + first.count));
  }
  followed_ = followed.get();
  return followed;
}

std::string ScanSource::name() const {
  return recording_.path == datasets::kStandardInput
             ? "standard input"
             : std::filesystem::absolute(recording_.path).lexically_normal().filename().string();
}

void ScanSource::begin_at(std::size_t first) {
  if (grows()) {
    reader_.emplace(*followed_, first, scans_.end);
  } else {
    reader_.emplace(std::as_const(*dataset_), first, scans_.end);
  }
}

bool ScanSource::has_next() {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  const Clock::time_point begun = Clock::now();
  while (grows() && !was_stopped_ && !reader_->wait(kAskAgain)) {
    if (stop_ && stop_()) {
      reader_->stop();
      was_stopped_ = true;
    } else if (settings_.follow_timeout_s && Clock::now() - begun > Seconds(*settings_.follow_timeout_s)) {
      reader_->stop();
      warn_(fmt::format("no scan came for {} s: the run ends", *settings_.follow_timeout_s));
      break;
    }
  }
  return !was_stopped_ && !reader_->done();
}

RawScan ScanSource::next() {
  RawScan scan = reader_->next();
  for (const std::string& note : reader_->notes()) {
    warn_(note);
  }
  if (!scan.warning.empty()) {
    warn_(scan.warning);
  }
  return scan;
}

void ScanSource::complete(RunTruth& truth, std::size_t count) {
  reader_.reset();  // nobody else may read beside it
  if (!grows()) {
    return;
  }
  const std::string known = truth.warning;
  try {
    followed_->finish();
    if (settings_.ground_truth.empty()) {
      truth = truth_for_run(*dataset_, {scans_.begin, scans_.begin + count}, {});
    }
  } catch (const DataError& error) {
    warn_(fmt::format("no ground truth: {}", error.what()));
  }
  for (const std::string& note : followed_->take_notes()) {
    warn_(note);
  }
  if (truth.warning != known && !truth.warning.empty()) {
    warn_(truth.warning);
  }
}

}  // namespace dynamic_icp::runs
