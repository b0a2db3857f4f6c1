// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/run_context.hpp"

namespace dynamic_icp::report {

/// Fewer points do not show a scene: where the budget gives a scan less, scans are left out instead.
inline constexpr std::size_t kMinPoints = 2000;

/// The largest number of points per scan for which all scans together stay within `total` points, where no scan gives
/// more than it has.
std::size_t even_share(std::span<const std::size_t> points, std::size_t total);

/// `count` of `n` frames, evenly spread, the first and the last among them; ascending.
std::vector<std::size_t> spread_frames(std::size_t n, std::size_t count);

/// The frames worth a whole scan, ascending and at most a handful: most points on objects, largest errors, the first
/// that was degenerate, the first that was lost, the first and the middle one.
std::vector<std::size_t> informative_frames(const runs::RunFiles& run, const std::optional<figures::RunTruth>& truth);

/// Which scans a page keeps.
struct KeptFrames {
  std::vector<std::size_t> frames;  ///< ascending; those to be kept whole among them
  std::size_t points = 0;           ///< of each of the others, as far as they have so many
};

/// Divides `total` points among the scans that are not kept `whole`: all of them where each gets kMinPoints, else
/// fewer. `points` are those of each scan in the recording.
KeptFrames kept_frames(std::span<const std::size_t> points, std::span<const std::size_t> whole, std::size_t total);

}  // namespace dynamic_icp::report
