// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/scan_record.hpp"

#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"

namespace dynamic_icp::runs {

void ScanRecord::state(StateArchive& archive) {
  bool has_covariance = covariance.has_value();
  Matrix6d numbers = covariance.value_or(Matrix6d::Zero());  // always there, so that all records are of one length
  archive(status, stamp, T_world_sensor, has_covariance, numbers, is_aligned, iterations, points, points_used,
          dropped.non_finite, dropped.implausible, dropped.zero_range, dropped.out_of_range, dropped.flagged,
          dynamic_candidates, dynamic_clustered, dynamic_refined, total_ms);
  covariance = has_covariance ? std::optional(numbers) : std::nullopt;
}

ScanRecord scan_record(const odometry::Frame& frame) {
  return {.status = frame.status,
          .stamp = frame.stamp,
          .T_world_sensor = frame.T_world_sensor,
          .covariance = frame.alignment.covariance,
          .is_aligned = frame.alignment.status != registration::AlignStatus::kNotRun,
          .iterations = frame.alignment.iterations,
          .points = frame.points,
          .points_used = frame.points_used,
          .dropped = frame.dropped,
          .dynamic_candidates = frame.dynamic_candidates,
          .dynamic_clustered = frame.dynamic_clustered,
          .dynamic_refined = frame.dynamic_refined,
          .total_ms = frame.times.total_ms};
}

std::string record_bytes(ScanRecord record) {
  StateArchive archive;
  record.state(archive);
  return archive.take();
}

std::uintmax_t record_file_bytes(std::size_t records) { return records * record_bytes({}).size(); }

std::size_t for_each_record(const std::filesystem::path& path,
                            const std::function<void(const ScanRecord& record)>& use) {
  const std::size_t size = record_bytes({}).size();
  formats::RecordFile file(path, size, std::numeric_limits<std::uintmax_t>::max());
  std::size_t count = 0;
  for (std::string_view block = file.next(); !block.empty(); block = file.next()) {
    for (; !block.empty(); block.remove_prefix(size)) {
      ScanRecord record;
      try {
        StateArchive archive(block.substr(0, size));
        record.state(archive);
        archive.end();
      } catch (const DataError& error) {
        throw DataError(fmt::format("{}: record {}: {}", path.string(), count + 1, error.what()));
      }
      ++count;
      use(record);
    }
  }
  if (count * size != file.bytes()) {
    throw DataError(fmt::format("{}: has {} bytes, expected a multiple of {}", path.string(), file.bytes(), size));
  }
  return count;
}

}  // namespace dynamic_icp::runs
