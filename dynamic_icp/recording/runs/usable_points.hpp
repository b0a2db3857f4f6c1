// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>

#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::runs {

/// What became of the points of a run, to tell why nothing came of it.
class UsablePoints {
 public:
  void add(const odometry::Frame& frame);

  [[nodiscard]] std::size_t scans() const { return scans_; }

  /// A trajectory of poses that nobody saw is no result. Throws DataError naming the recording when not one scan could
  /// be used.
  void refuse_none(const std::filesystem::path& recording) const;

  void state(StateArchive& archive);

 private:
  std::size_t scans_ = 0;
  std::size_t unusable_ = 0;  ///< scans with too few points to work with
  std::size_t points_ = 0;
  std::size_t points_used_ = 0;
  Scan::Dropped dropped_;
};

}  // namespace dynamic_icp::runs
