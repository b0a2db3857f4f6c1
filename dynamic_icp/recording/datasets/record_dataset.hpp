// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/scan_stamps.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"
#include "dynamic_icp/recording/formats/point_records.hpp"

namespace dynamic_icp::datasets {

/// A recording of one file of records per scan, found and looked through by the reader of its layout.
struct RecordRecording {
  std::string_view format;
  StampedFiles scans;  ///< at least one
  std::function<const formats::RecordLayout&(const std::filesystem::path& file, Stamp stamp)> layout_of;
  /// Folder of the times of points, a file of float32 for each scan, seconds after its stamp unless numbers and period
  /// say otherwise (point_times.hpp); empty: none.
  std::filesystem::path times = {};
  Truth truth;
  std::optional<Eigen::Isometry3d> T_vehicle_sensor = {};
  DopplerKind doppler_kind = DopplerKind::kRelative;
  std::function<void(RawScan& scan, const std::filesystem::path& file)> correct = {};  ///< of what was read, if set
};

/// The recording as a dataset. Its scans throw DataError for numbers that were never measured (record_guess.hpp).
std::unique_ptr<Dataset> make_record_dataset(RecordRecording recording);

}  // namespace dynamic_icp::datasets
