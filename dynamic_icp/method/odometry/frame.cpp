// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/frame.hpp"

namespace dynamic_icp::odometry {

std::string_view to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::kNotRun:
      return "not_run";
    case FrameStatus::kFirst:
      return "first";
    case FrameStatus::kConverged:
      return "converged";
    case FrameStatus::kIterationLimit:
      return "iteration_limit";
    case FrameStatus::kTooFewCorrespondences:
      return "too_few_correspondences";
    case FrameStatus::kDegenerate:
      return "degenerate";
    case FrameStatus::kAmbiguous:
      return "ambiguous";
    case FrameStatus::kTooFewPoints:
      return "too_few_points";
    case FrameStatus::kTimeGap:
      return "time_gap";
    case FrameStatus::kTooSoon:
      return "too_soon";
    case FrameStatus::kDiverged:
      return "diverged";
    case FrameStatus::kLost:
      return "lost";
  }
  return "unknown";
}

std::string_view verdict(FrameStatus status) {
  switch (status) {
    case FrameStatus::kFirst:
    case FrameStatus::kConverged:
    case FrameStatus::kIterationLimit:
      return "ok";
    case FrameStatus::kDegenerate:
    case FrameStatus::kAmbiguous:
      return "degenerate";
    case FrameStatus::kNotRun:
    case FrameStatus::kTooFewCorrespondences:
    case FrameStatus::kTooFewPoints:
    case FrameStatus::kTimeGap:
    case FrameStatus::kTooSoon:
    case FrameStatus::kDiverged:
    case FrameStatus::kLost:
      break;
  }
  return "lost";
}

std::string_view to_string(Stage stage) {
  switch (stage) {
    case Stage::kPreprocess:
      return "preprocess";
    case Stage::kNormals:
      return "normals";
    case Stage::kEgoMotion:
      return "ego_motion";
    case Stage::kDynamics:
      return "dynamics";
    case Stage::kRegistration:
      return "registration";
  }
  return "unknown";
}

}  // namespace dynamic_icp::odometry
