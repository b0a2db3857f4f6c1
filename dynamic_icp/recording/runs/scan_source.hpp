// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/followed_dataset.hpp"
#include "dynamic_icp/recording/datasets/read_ahead.hpp"
#include "dynamic_icp/recording/datasets/scan_range.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"
#include "dynamic_icp/recording/runs/run_truth.hpp"

namespace dynamic_icp::runs {

/// Where the scans of a run come from: a recording that is there, or one that grows and is waited for. They are handed
/// out in their order, the next one being read in the meantime.
class ScanSource {
 public:
  using Stop = std::function<bool()>;
  using Warn = std::function<void(const std::string& text)>;

  /// Opens the recording; of one that grows waits for its first scans. Recording and settings must outlive it. `stop`
  /// is asked many times a second while scans are waited for, and may be empty; `warn` is told what is odd.
  ///
  /// Throws as open_input, follow_input and select_scans do; DataError where `stop` ended the wait for the first scans.
  ScanSource(const Recording& recording, const RunSettings& settings, Stop stop, Warn warn);

  [[nodiscard]] const datasets::Dataset& dataset() const { return *dataset_; }

  /// What the recording is called: the name of its file or folder, "standard input".
  [[nodiscard]] std::string name() const;

  [[nodiscard]] bool grows() const { return followed_ != nullptr; }

  /// The scans that were there at the beginning and can be looked at before the run: of a recording that grows a few.
  [[nodiscard]] datasets::ScanRange first_scans() const { return first_scans_; }

  /// Those of the run. Of a recording that grows the end is the greatest number there is, unless the settings have one.
  [[nodiscard]] datasets::ScanRange scans() const { return scans_; }

  /// How many these are; 0 where nobody knows.
  [[nodiscard]] std::size_t total() const { return grows() ? 0 : scans_.size(); }

  /// Begins to read with scan `first`. Before any of the following.
  void begin_at(std::size_t first);

  /// Whether another scan is there; of a recording that grows once it is, or it is known that none will come: it was
  /// closed, `stop` said so, or none came for as long as the settings have it.
  bool has_next();

  /// Whether `stop` ended the wait.
  [[nodiscard]] bool was_stopped() const { return was_stopped_; }

  /// The next scan, which must be there; what is odd about it is told. Throws what Dataset::scan throws.
  RawScan next();

  /// When the scan that was handed out last came; nothing where it was there before.
  [[nodiscard]] std::optional<datasets::Arrival> arrival() const { return reader_->arrival(); }

  /// After the last scan, of which `count` were handed out: the ground truth of a recording that grew becomes that of
  /// all that came. Of others it stays as it is.
  void complete(RunTruth& truth, std::size_t count);

 private:
  std::unique_ptr<datasets::Dataset> open();
  [[nodiscard]] std::optional<std::size_t> scans_to_check() const;

  const Recording& recording_;
  const RunSettings& settings_;
  Stop stop_;
  Warn warn_;
  datasets::FollowedDataset* followed_ = nullptr;  ///< the same as dataset_, where it grows
  std::unique_ptr<datasets::Dataset> dataset_;
  datasets::ScanRange first_scans_;
  datasets::ScanRange scans_;
  bool was_stopped_ = false;
  std::optional<datasets::ReadAhead> reader_;  // the first to go: it reads from the dataset
};

}  // namespace dynamic_icp::runs
