// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/registration/alignment.hpp"

namespace dynamic_icp::registration {

std::string_view to_string(AlignStatus status) {
  switch (status) {
    case AlignStatus::kNotRun:
      return "not_run";
    case AlignStatus::kConverged:
      return "converged";
    case AlignStatus::kIterationLimit:
      return "iteration_limit";
    case AlignStatus::kTooFewCorrespondences:
      return "too_few_correspondences";
    case AlignStatus::kDiverged:
      return "diverged";
    case AlignStatus::kDegenerate:
      return "degenerate";
  }
  return "unknown";
}

}  // namespace dynamic_icp::registration
