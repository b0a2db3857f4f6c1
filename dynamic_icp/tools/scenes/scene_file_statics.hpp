// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/tools/scenes/scene_file_routes.hpp"
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

// The surfaces of a scene file.
namespace dynamic_icp::scenes {

/// Adds something that was read and checked to a mesh.
using StaticPart = std::function<void(world::TriangleMesh& mesh, const RandomSource& random)>;

/// The list `statics` of a scene file.
std::vector<StaticPart> read_statics(const formats::YamlMap& file, const Routes& routes);

}  // namespace dynamic_icp::scenes
