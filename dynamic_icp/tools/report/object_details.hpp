// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/report/json_text.hpp"

namespace dynamic_icp::report {

/// Standard deviations of what is stated of an object. NaN where nothing is stated, of directions also where the object
/// does not move.
struct ObjectSigmas {
  double speed_mps = 0.0;
  double heading_deg = 0.0;     ///< of the velocity, about the z axis of the sensor
  double radial_mps = 0.0;      ///< of the velocity along the line of sight, which the Doppler measures
  double tangential_mps = 0.0;  ///< across it, in the horizontal plane of the sensor
  double centre_m = 0.0;        ///< in the worst direction
};

ObjectSigmas object_sigmas(const runs::ObjectRow& object);

/// "object_details" of a run (docs/report.md): per frame a list with an entry for each object. Null when no object of
/// the run is tracked.
Json object_details(const runs::RunFiles& run);

}  // namespace dynamic_icp::report
