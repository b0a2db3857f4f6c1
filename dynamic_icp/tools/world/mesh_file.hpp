// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "dynamic_icp/tools/world/triangle_mesh.hpp"

namespace dynamic_icp::world {

/// Reads a surface from a PLY file, with the usual reflectivity everywhere. The elements `vertex` (x, y, z) and `face`
/// (vertex_indices or vertex_index) count. Polygons become fans about their first corner. Faces without area and
/// vertices without a face are left out.
///
/// Throws DataError naming file, record and what was expected: for coordinates that are not finite or beyond 1e12,
/// indices of no vertex, faces with fewer than three corners and files without any surface.
TriangleMesh load_mesh(const std::filesystem::path& path);

}  // namespace dynamic_icp::world
