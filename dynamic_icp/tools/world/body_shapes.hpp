// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/tools/world/triangle_mesh.hpp"

namespace dynamic_icp::world {

// Shapes of road users in their body frame: origin on the road below the middle, x forward, y left, z up.

/// 4.4 x 1.8 x 1.5 m: body with bonnet and boot, cabin with slanted windows, four wheels.
TriangleMesh make_car();

/// 5.6 x 2.0 x 2.4 m: bonnet and box, four wheels.
TriangleMesh make_van();

/// 10 x 2.5 x 3.6 m: cab, cargo box, six wheels.
TriangleMesh make_truck();

/// 0.5 x 0.5 x 1.75 m: legs, trunk, head.
TriangleMesh make_pedestrian();

}  // namespace dynamic_icp::world
