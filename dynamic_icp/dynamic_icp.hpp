// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

/// Dynamic-ICP as a library, component `core`:
///
///   const auto odometry = dynamic_icp::odometry::make_odometry();
///   const dynamic_icp::odometry::Frame frame = odometry->process(scan);  // a dynamic_icp::RawScan
///   frame.T_world_sensor, frame.status, frame.ego, frame.tracked ...
///
/// Everything in namespace dynamic_icp; frames in names (T_target_source), SI units.
#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/method/dynamics/prediction.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"
