// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp::odometry {

/// Writes the time since the last stage ended into the frame's times.
class StageClock {
 public:
  explicit StageClock(StageTimes& times) : times_(times) {}

  void finish(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    times_.ms[static_cast<std::size_t>(stage)] += ms;
    times_.total_ms += ms;
    last_ = now;
  }

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace dynamic_icp::odometry
