// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "dynamic_icp/method/odometry/frame.hpp"
#include "dynamic_icp/method/registration/align.hpp"

namespace dynamic_icp::runs {

/// One line of frames.jsonl, without its line break. `index` is that of the scan in the recording.
std::string frame_line(std::size_t index, const odometry::Frame& frame);

/// One line of objects.jsonl, without its line break: the accepted objects, with ids 1, 2, ... as in the labels.
std::string objects_line(std::size_t index, const odometry::Frame& frame);

/// The frame of the second of two scans as an indented JSON document: what `register` prints. `source` is the frame of
/// the first one, `assumptions` what the method had to take for granted.
std::string pair_document(const odometry::Frame& source, const odometry::Frame& target,
                          const std::vector<std::string>& assumptions = {});

}  // namespace dynamic_icp::runs
