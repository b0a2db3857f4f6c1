// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "dynamic_icp/recording/evaluation/object_tracking.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"
#include "dynamic_icp/tools/figures/run_figures.hpp"
#include "dynamic_icp/tools/figures/shown_scan.hpp"

namespace dynamic_icp::figures {

/// A true body and what is reported of it from above: the points around them as the run saw them, both boxes, and
/// arrows as long as the way covered in half a second; in words the overlap and the errors.
drawing::Svg object_figure(const evaluation::BodyPair& pair, const ShownScan& scan, const drawing::Theme& theme);

/// "worst_object_1", ...: the pairs of a run over a simulated recording whose boxes overlap least, at most `count`,
/// each of another true body. Throws DataError naming the file when the recording or its objects.jsonl is gone, or
/// objects of the run have no boxes.
std::vector<Figure> draw_worst_objects(const runs::RunFiles& run, std::size_t count, const drawing::Theme& theme);

}  // namespace dynamic_icp::figures
