// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp::live {

/// Odometry goes before those who watch it: the calling thread yields to others. What the system does not allow is left
/// as it is.
void lower_own_priority();

/// Names the calling thread for those who look at what a process does (`top -H`, scripts/measure_live.mjs). At most 15
/// bytes.
void name_own_thread(const char* name);

}  // namespace dynamic_icp::live
