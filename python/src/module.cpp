// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <string>

#include <pybind11/pybind11.h>

#include "dynamic_icp/method/base/version.hpp"

#include "python/src/bindings.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace dynamic_icp::python;
  module.doc() = "What dynamic_icp is made of; use dynamic_icp itself.";
  module.attr("version") = std::string(dynamic_icp::version());
  bind_errors(module);
  bind_odometry(module);
  bind_recording(module);
  bind_run(module);
  bind_evaluation(module);
  bind_stages(module);
  bind_simulation(module);
}
