// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/runs/lost_scans.hpp"

// Exit statuses of the program, beside 0 for what is done.
namespace dynamic_icp::apps {

inline constexpr int kDataOrMachineFailed = 1;
inline constexpr int kWrongUsage = 2;
using runs::kMostScansLost;                 // of `run`: its results are there
inline constexpr int kEndedBySignal = 128;  ///< + the signal's number: how shells know it

}  // namespace dynamic_icp::apps
