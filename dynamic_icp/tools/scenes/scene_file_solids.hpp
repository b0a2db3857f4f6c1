// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include "dynamic_icp/recording/formats/yaml_map.hpp"
#include "dynamic_icp/tools/world/triangle_mesh.hpp"

// The solids of a scene file: surfaces in a frame of their own, which are part of the surroundings or of a body.
namespace dynamic_icp::scenes {

/// The solid of that kind; nothing for other kinds.
std::optional<world::TriangleMesh> read_solid(const std::string& kind, const formats::YamlMap& map);

/// All kinds of solids: "box, cylinder, ...".
std::string solid_names();

/// The key `reflectivity`; nothing where it is missing.
std::optional<double> read_reflectivity(const formats::YamlMap& map);

/// The list `parts` of a body, in the body's frame.
world::TriangleMesh read_body_shape(const formats::YamlMap& body);

}  // namespace dynamic_icp::scenes
