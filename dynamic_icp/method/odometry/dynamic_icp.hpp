// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/method/odometry/motion_by_geometry.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/method/odometry/published_compensated.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/method/odometry/stage_clock.hpp"

namespace dynamic_icp::odometry {

/// Dynamic-ICP over a stream of scans: from each scan to the next, with no other sensor and no calibration.
///
///   DynamicIcp odometry(PaperConfig{});
///   for (const RawScan& scan : scans) { Frame frame = odometry.process(scan); ... frame.T_world_sensor ... }
///
/// The same scans give the same bits for any number of threads.
class DynamicIcp final : public Odometry {
 public:
  /// `threads` = 0 takes as many as the machine has; `expected` is what the Doppler will be, for `assumptions`. Throws
  /// UsageError when the configuration is out of range.
  explicit DynamicIcp(const PaperConfig& config, int threads = 0, DopplerKind expected = DopplerKind::kRelative);
  ~DynamicIcp() override;
  DynamicIcp(DynamicIcp&&) noexcept;
  DynamicIcp& operator=(DynamicIcp&&) noexcept;

  /// Takes the next scan. Throws DataError when its stamp is not later than that of the previous scan; the state is
  /// unchanged then. A scan that cannot be aligned is no error: its frame says so and carries the predicted motion, and
  /// the next usable scan is aligned to the last usable one.
  Frame process(const ScanView& raw) override;

  [[nodiscard]] std::vector<std::string> assumptions() const override;

 private:
  struct Reference;

  void align_to_last(const Scan& scan, Frame& frame, StageClock& clock);
  std::vector<double> estimate_ego_motion(const Scan& scan, Frame& frame);
  [[nodiscard]] Eigen::Isometry3d predicted_motion() const;
  [[nodiscard]] Eigen::Vector3d velocity_prior(const Frame& frame) const;
  [[nodiscard]] std::vector<std::int32_t> cluster(const Scan& scan, const std::vector<std::uint8_t>& is_dynamic) const;
  [[nodiscard]] Config configuration() const override { return config_; }
  void state(StateArchive& archive) override;

  PaperConfig config_;
  Workers workers_;
  DopplerKind expected_;
  ScanStream stream_;
  std::unique_ptr<Reference> last_;  ///< the last usable scan; empty before the first
  MotionByGeometry by_geometry_;     ///< where the Doppler is compensated
  PublishedCompensated published_;   ///< likewise, as published
};

}  // namespace dynamic_icp::odometry
