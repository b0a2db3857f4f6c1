// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/recording/formats/trajectory.hpp"

#include "python/src/arrays.hpp"

namespace dynamic_icp::python {

/// Stamps (N,), ns, and poses (N, 4, 4).
py::tuple trajectory_arrays(const formats::Trajectory& trajectory);

/// Throws UsageError where the two differ in length.
formats::Trajectory trajectory_of(const py::array& stamps_ns, const py::array& poses, const char* name);

}  // namespace dynamic_icp::python
