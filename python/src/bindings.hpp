// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

// The parts of the extension module dynamic_icp._core, a file each. It takes and gives plain arrays, numbers and
// dictionaries; the classes and words that users see are Python, in python/dynamic_icp.
namespace dynamic_icp::python {

void bind_odometry(pybind11::module_& module);
void bind_recording(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_evaluation(pybind11::module_& module);
void bind_stages(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);

/// The exceptions, and how those of the library become them.
void bind_errors(pybind11::module_& module);

}  // namespace dynamic_icp::python
