// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/result_kinds.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> conversion_files(const fs::path& /*folder*/) {
  return {"conversion.json", "ref_poses.txt", "calibration.json", "point_clouds/#.bin", "times/#.bin", "#.npz",
          "#.pcd",           "#.ply",         "recording.mcap"};
}

}  // namespace

formats::ResultKind conversion_result() { return {"conversion.json", conversion_files}; }

}  // namespace dynamic_icp::apps
