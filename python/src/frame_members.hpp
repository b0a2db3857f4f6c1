// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/odometry/frame.hpp"

#include "python/src/arrays.hpp"

namespace dynamic_icp::python {

/// The members of a dynamic_icp.Frame; its objects and its ego velocity as dictionaries.
py::dict frame_members(odometry::Frame frame);

/// The members of a dynamic_icp.EgoVelocity.
py::dict ego_members(const ego_motion::EgoVelocity& ego);

}  // namespace dynamic_icp::python
