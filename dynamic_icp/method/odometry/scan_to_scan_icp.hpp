// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/method/odometry/scan_stream.hpp"
#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp::odometry {

/// The methods that align each scan to the one before and know no moving objects: point-to-point, point-to-plane and
/// plane-to-plane as Open3D's registration_icp and registration_generalized_icp with normals, and Doppler-ICP as
/// published, with the mounting of the sensor. The start is the identity or the last motion
/// (`icp.constant_velocity_start`); with `icp.deskew` the last motion also deskews, from the third scan on. The pose
/// is that at the stamp all the same; its covariance is that of the alignment of the middles of two scans.
class ScanToScanIcp final : public Odometry {
 public:
  /// Both throw UsageError when the configuration is out of range.
  explicit ScanToScanIcp(const ScanToScanIcpConfig& config, int threads = 0);
  ScanToScanIcp(const DopplerIcpConfig& config, const SensorContext& context, int threads = 0);
  ~ScanToScanIcp() override;

  Frame process(const ScanView& raw) override;
  [[nodiscard]] std::vector<std::string> assumptions() const override;

 private:
  struct Reference;

  double deskew(Scan& scan, const ScanView& raw, Frame& frame) const;
  void align_to_last(const Reference& now, Frame& frame) const;
  [[nodiscard]] Eigen::Isometry3d predicted_motion() const;
  [[nodiscard]] registration::Objective objective(DopplerKind kind, double dt_s) const;
  [[nodiscard]] registration::PreparedTarget prepared(Scan points) const;
  [[nodiscard]] Config configuration() const override;
  void state(StateArchive& archive) override;

  ScanToScanIcpConfig config_;
  std::optional<DopplerIcpConfig> doppler_icp_;        ///< of Doppler-ICP only
  std::optional<Eigen::Isometry3d> T_vehicle_sensor_;  ///< of Doppler-ICP only: it then works in the vehicle frame
  Workers workers_;
  DopplerKind expected_;
  ScanStream stream_;
  std::unique_ptr<Reference> last_;  ///< the last usable scan; empty before the first
};

}  // namespace dynamic_icp::odometry
