// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/tools/world/towing.hpp"
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

namespace dynamic_icp::world {

// Shapes of road users in their body frame: origin on the road below the middle, x forward, y left, z up.

/// 4.4 x 1.8 x 1.5 m: body with bonnet and boot, cabin with slanted windows, four wheels.
TriangleMesh make_car();

/// 5.6 x 2.0 x 2.4 m: bonnet and box, four wheels.
TriangleMesh make_van();

/// 10 x 2.5 x 3.6 m: cab, cargo box, six wheels.
TriangleMesh make_truck();

/// 6 x 2.5 x 3.6 m: cab, and behind it a low frame that carries the front of a semitrailer, four wheels.
TriangleMesh make_tractor();

/// 13.6 x 2.5 x 4 m: box with six wheels below its rear.
TriangleMesh make_semitrailer();

/// How the one hangs on the other.
inline constexpr Hitch kSemitrailerHitch = {-1.5, 5.3, -3.7};

/// 7.4 x 2.5 x 3.6 m: box, four wheels below its middle; its drawbar is too thin to be seen.
TriangleMesh make_trailer();

/// How it hangs on the truck.
inline constexpr Hitch kTrailerHitch = {-5.3, 5.3, 0.0};

/// 0.5 x 0.5 x 1.75 m: legs, trunk, head.
TriangleMesh make_pedestrian();

}  // namespace dynamic_icp::world
