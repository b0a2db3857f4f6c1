// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp::odometry {

/// The methods that align each scan to the one before and know no moving objects.
enum class ScanToScanMethod {
  kPointToPoint,  ///< as Open3D's registration_icp with TransformationEstimationPointToPoint
  kPointToPlane,  ///< as Open3D's registration_icp with TransformationEstimationPointToPlane
  kGicp,          ///< as Open3D's registration_generalized_icp with normals
  kDopplerIcp     ///< Doppler-ICP as published, with the mounting of the sensor
};

/// Preprocessing, gate and stopping rule are those of dynamic-icp; terms, weights and rejection rules are the method's.
/// The start is the identity or the last motion (`icp.constant_velocity_start`).
class ScanToScanIcp final : public Odometry {
 public:
  /// Throws UsageError when the configuration is out of range.
  ScanToScanIcp(ScanToScanMethod method, const Config& config, const Surroundings& surroundings, int threads = 0);
  ~ScanToScanIcp() override;

  Frame process(const RawScan& raw) override;
  [[nodiscard]] std::vector<std::string> assumptions() const override;

 private:
  struct Reference;

  void align_to_last(const Reference& now, Frame& frame) const;
  [[nodiscard]] std::optional<double> interval_s(Stamp stamp) const;
  void continue_motion(Frame& frame, FrameStatus status) const;
  [[nodiscard]] Eigen::Isometry3d predicted_motion(Stamp stamp) const;
  [[nodiscard]] registration::Objective objective(DopplerKind kind, double dt_s) const;

  ScanToScanMethod method_;
  Config config_;
  std::optional<Eigen::Isometry3d> T_vehicle_sensor_;  ///< of Doppler-ICP only: it then works in the vehicle frame
  Workers workers_;
  DopplerKind expected_;
  std::optional<Stamp> last_stamp_;
  std::unique_ptr<Reference> last_;  ///< the last usable scan; empty before the first
};

}  // namespace dynamic_icp::odometry
