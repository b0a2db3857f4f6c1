// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamic_icp/tools/scenes/scene.hpp"

namespace dynamic_icp::scenes {

/// Reads a scene that a user described in a YAML file (docs/scenes.md). The whole file is checked here, and the mesh
/// files that it names are read: building the scene does not fail and reads no files.
///
/// The kind is called after the file ("crossing" for crossing.yaml). Throws UsageError naming file, line, key and what
/// is allowed; DataError for files that cannot be read, are no YAML or no meshes.
SceneKind load_scene_file(const std::filesystem::path& path);

}  // namespace dynamic_icp::scenes
