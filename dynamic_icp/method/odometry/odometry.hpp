// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp {
class StateArchive;
}  // namespace dynamic_icp

namespace dynamic_icp::odometry {

/// A method over a stream of scans. The same scans give the same bits for any number of threads.
class Odometry {
 public:
  virtual ~Odometry() = default;

  /// Takes the next scan. Throws DataError when its stamp is not later than that of the previous scan, and
  /// std::invalid_argument when its columns differ in length; the state is unchanged then. No number in a scan makes it
  /// throw: what cannot be a measurement is dropped and counted, and all numbers of the frame are finite. A scan that
  /// cannot be aligned is no error: its frame says so.
  virtual Frame process(const ScanView& scan) = 0;

  /// What the method had to take for granted because it was not told, for all outputs; usually nothing.
  [[nodiscard]] virtual std::vector<std::string> assumptions() const { return {}; }

  /// What was learned of the sensor so far; nothing where a method does not.
  [[nodiscard]] virtual std::optional<window::SensorCalibration> calibration() const { return std::nullopt; }

  /// What it knows after the scans so far, in bytes. Another object of the same configuration and version that loads
  /// them gives the same bits for the scans that follow.
  [[nodiscard]] std::string save();

  /// Goes on where `save` was called, in whatever state this one is. Throws DataError when the bytes are damaged, or
  /// come from another version or configuration, which it names; the object is of no use then.
  void load(std::string_view bytes);

 private:
  [[nodiscard]] virtual Config configuration() const = 0;
  virtual void state(StateArchive& archive) = 0;
  void all_state(StateArchive& archive);
};

/// What a method may know besides the scans.
struct SensorContext {
  std::optional<Eigen::Isometry3d> T_vehicle_sensor;  ///< mounting of the sensor, where the recording has it
  /// What the Doppler of the scans will be, for `assumptions`; each scan says itself what is done with it.
  DopplerKind doppler_kind = DopplerKind::kRelative;
  /// What was learned of this sensor in another recording; for preset `default`. With that of another sensor the first
  /// scan throws UsageError.
  std::optional<window::SensorCalibration> calibration = {};
};

/// Whether the method of that name takes the Doppler into account: without any, its results are not its own.
bool needs_doppler(std::string_view method);

/// The pipeline of a configuration: `make_odometry(PaperConfig{})`, `make_odometry(configuration("kiss-icp"))`; an
/// empty one is preset `default`. `threads` = 0 takes as many as the machine has. Throws UsageError when the
/// configuration, the mounting or the calibration is out of range, and for a calibration that the method has no use
/// for.
std::unique_ptr<Odometry> make_odometry(const Config& config = {}, const SensorContext& context = {}, int threads = 0);

}  // namespace dynamic_icp::odometry
