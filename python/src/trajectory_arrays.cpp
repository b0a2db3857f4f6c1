// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "python/src/trajectory_arrays.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::python {

py::tuple trajectory_arrays(const formats::Trajectory& trajectory) {
  std::vector<std::int64_t> stamps;
  std::vector<Eigen::Isometry3d> poses;
  for (const formats::StampedPose& pose : trajectory) {
    stamps.push_back(pose.stamp.ns);
    poses.push_back(pose.T_world_sensor);
  }
  return py::make_tuple(moved(std::move(stamps)), copied(poses));
}

formats::Trajectory trajectory_of(const py::array& stamps_ns, const py::array& poses, const char* name) {
  const std::vector<Eigen::Isometry3d> all = poses_of(poses, name);
  const auto stamps = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(stamps_ns);
  if (stamps.ndim() != 1 || static_cast<std::size_t>(stamps.size()) != all.size()) {
    throw UsageError(fmt::format("{} has {} poses and {} stamps", name, all.size(), stamps.size()));
  }
  formats::Trajectory trajectory;
  for (std::size_t i = 0; i < all.size(); ++i) {
    trajectory.push_back({Stamp{stamps.at(static_cast<py::ssize_t>(i))}, all[i]});
  }
  return trajectory;
}

}  // namespace dynamic_icp::python
