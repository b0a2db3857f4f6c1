// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::datasets {

// What the sequence.json of an AevaScenes sequence says, releases v0.x and v2.

/// Where the points of one LiDAR in one frame lie, in the folder of the sequence; empty where the release has none.
struct AevaScenesPaths {
  std::string compensated;
  std::string raw;
};

/// An object with its pose in the vehicle.
struct AevaScenesBox {
  std::string id;
  std::string class_name;
  Eigen::Isometry3d T_vehicle_box = Eigen::Isometry3d::Identity();
  Eigen::Vector3d dimensions = Eigen::Vector3d::Zero();        ///< m, full lengths
  Eigen::Vector3d velocity_vehicle = Eigen::Vector3d::Zero();  ///< m/s over ground, in vehicle axes
};

struct AevaScenesFrame {
  Stamp stamp;
  std::optional<Eigen::Isometry3d> T_world_vehicle;  ///< nothing where the frame has no pose
  std::map<std::string, AevaScenesPaths> clouds;     ///< by LiDAR; one may be missing
  std::vector<AevaScenesBox> boxes;
};

struct AevaScenesSequence {
  std::vector<std::string> lidars;  ///< in the order of the file
  std::map<std::string, Eigen::Isometry3d> T_vehicle_lidar;
  std::vector<AevaScenesFrame> frames;  ///< at least one, with strictly increasing stamps
  std::vector<std::string> warnings;    ///< what is odd, in sentences
};

/// Reads such a file. Throws DataError naming the file, the frame and what was expected: no JSON, keys missing or of
/// another type, rotations that are none, paths that leave the folder of the sequence, two frames with the same stamp,
/// a sequence without frames.
AevaScenesSequence read_aevascenes_sequence(const std::filesystem::path& path);

}  // namespace dynamic_icp::datasets
