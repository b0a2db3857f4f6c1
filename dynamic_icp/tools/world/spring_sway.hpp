// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/world/drive.hpp"

namespace dynamic_icp::world {

/// The springs of a road vehicle: heave, pitch and roll as sums of slow sines (about 1 cm, 0.4 and 0.4 deg at scale 1).
SwayFunction spring_sway(double scale, const RandomSource& random);

}  // namespace dynamic_icp::world
