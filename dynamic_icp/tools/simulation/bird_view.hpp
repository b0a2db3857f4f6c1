// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/tools/drawing/raster.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/world/ray_caster.hpp"
#include "dynamic_icp/tools/world/world.hpp"

namespace dynamic_icp::simulation {

/// What is static in a rectangle (m) of the ground plane, seen from above: x to the right, y up, lit from the side,
/// in a stronger tone the farther it is from the height of the road; the theme's panel colour where there is nothing.
/// Moving bodies are left out.
drawing::Raster bird_view(const world::World& world, const world::RayCaster& caster, const Eigen::AlignedBox2d& region,
                          std::size_t width, std::size_t height, const drawing::Theme& theme, const Workers& workers);

}  // namespace dynamic_icp::simulation
