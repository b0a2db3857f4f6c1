// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::tracking {

/// Which moving points are of one body (moving_cells.hpp).
struct GroupingConfig {
  double cell_size_m = 0.5;          ///< edge of the cubes that thin the points
  double link_distance_m = 0.7;      ///< between cells of one object, at the sensor
  double link_growth = 0.008;        ///< m per metre of range: points lie wider apart far away
  double link_velocity_mps = 0.3;    ///< between radial velocities of neighbours
  double link_shear_rps = 0.7;       ///< and so much more per metre between them: turning bodies
  double bridge_m = 3.0;             ///< longest gap in a body where its radial velocity passes zero
  double bridge_velocity_mps = 1.0;  ///< cells beside such a gap are at most so fast
};

ConfigFields fields(GroupingConfig& config);

}  // namespace dynamic_icp::tracking
