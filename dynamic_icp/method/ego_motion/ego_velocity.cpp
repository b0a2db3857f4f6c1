// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/ego_velocity.hpp"

namespace dynamic_icp::ego_motion {

std::string_view to_string(EgoVelocityStatus status) {
  switch (status) {
    case EgoVelocityStatus::kNotRun:
      return "not_run";
    case EgoVelocityStatus::kConverged:
      return "converged";
    case EgoVelocityStatus::kIterationLimit:
      return "iteration_limit";
    case EgoVelocityStatus::kTooFewPoints:
      return "too_few_points";
    case EgoVelocityStatus::kFromMotion:
      return "from_motion";
    case EgoVelocityStatus::kDegenerate:
      return "degenerate";
    case EgoVelocityStatus::kAmbiguous:
      return "ambiguous";
  }
  return "unknown";
}

}  // namespace dynamic_icp::ego_motion
