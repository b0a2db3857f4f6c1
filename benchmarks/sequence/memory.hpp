// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

// Resident memory of this process as Linux tells it.
namespace dynamic_icp::speed {

/// Gives memory that was freed back to the system, as far as the C library can, and lets the peak begin anew. False
/// where the system cannot: the peak is that of the whole process then.
bool restart_peak();

/// MiB in use now, and the most since the start or the last `restart_peak`; 0 where the system does not tell.
double resident_mib();
double peak_resident_mib();

}  // namespace dynamic_icp::speed
