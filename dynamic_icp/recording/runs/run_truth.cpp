// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_truth.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"
#include "dynamic_icp/recording/evaluation/association.hpp"

namespace dynamic_icp::runs {
namespace {

/// Why no scan has a pose of the ground truth at its time; empty where one has.
std::string mismatch(const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                     const formats::Trajectory& truth) {
  formats::Trajectory at_scans;
  for (std::size_t i = scans.begin; i < scans.end; ++i) {
    at_scans.push_back({dataset.stamp(i), Eigen::Isometry3d::Identity()});
  }
  try {
    evaluation::associate(at_scans, truth);
    return {};
  } catch (const DataError& error) {
    return error.what();
  }
}

}  // namespace

RunTruth truth_for_run(const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                       const std::filesystem::path& stated) {
  const bool is_stated = !stated.empty();
  RunTruth truth{is_stated ? stated : dataset.ground_truth_file(),
                 is_stated ? datasets::read_truth(stated, datasets::stamps_of(dataset)) : dataset.ground_truth(),
                 {}};
  if (truth.trajectory.empty()) {
    return truth;
  }
  const std::string reason = mismatch(dataset, scans, truth.trajectory);
  if (reason.empty()) {
    return truth;
  }
  if (is_stated) {
    throw DataError(fmt::format("{}: does not fit the scans: {}", stated.string(), reason));
  }
  return {{}, {}, fmt::format("the ground truth {} is not used: {}", truth.file.string(), reason)};
}

}  // namespace dynamic_icp::runs
