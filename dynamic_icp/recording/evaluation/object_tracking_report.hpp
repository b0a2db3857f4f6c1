// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "dynamic_icp/recording/evaluation/object_tracking.hpp"

namespace dynamic_icp::evaluation {

/// The comparison as a table to read, or as one JSON object with every number, null where there is none. Both end with
/// a line break.
std::string tracking_table(const ObjectTracking& tracking);
std::string tracking_json(const ObjectTracking& tracking);

}  // namespace dynamic_icp::evaluation
