// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/tracked_object.hpp"

namespace dynamic_icp::tracking {

std::string_view to_string(TrackStatus status) {
  switch (status) {
    case TrackStatus::kTentative:
      return "tentative";
    case TrackStatus::kConfirmed:
      return "confirmed";
    case TrackStatus::kCoasting:
      return "coasting";
  }
  return "unknown";
}

std::string_view to_string(FaceView view) {
  switch (view) {
    case FaceView::kUnknown:
      return "unknown";
    case FaceView::kHidden:
      return "hidden";
    case FaceView::kSeen:
      return "seen";
  }
  return "unknown";
}

}  // namespace dynamic_icp::tracking
