// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "dynamic_icp/tools/drawing/svg.hpp"
#include "dynamic_icp/tools/drawing/theme.hpp"

namespace dynamic_icp::figures {

/// One line over time. Values that are not finite leave a gap.
struct Series {
  std::string name;
  std::vector<double> values;  ///< one per time
  bool broad = false;          ///< a broad pale line, for what the others are compared with
};

/// A value that lines are compared with, drawn across the whole area.
struct Level {
  double value = 0.0;
  std::string name;
};

/// Some lines in one drawing area.
struct Panel {
  std::string title;
  std::string label;  ///< of the vertical axis, with the unit: "speed (m/s)"
  std::vector<Series> series;
  bool from_zero = true;       ///< the axis includes zero (linear scale)
  bool whole_numbers = false;  ///< counts: no ticks in between
  bool logarithmic = false;    ///< the axis is logarithmic; values <= 0 stand at its lower end
  std::vector<Level> levels = {};
};

struct PanelSize {
  double width = 560.0;   ///< px
  double height = 210.0;  ///< px of one drawing area
  bool with_titles = true;
};

/// The panels below each other over one time axis (s).
drawing::Svg series_plot(const std::vector<double>& times, const std::vector<Panel>& panels,
                         const drawing::Theme& theme, const PanelSize& size = {});

/// Whether a few values tower over the rest, so that only a logarithmic axis shows both.
bool spans_decades(const std::vector<double>& values);

/// Whether some lines lie so far below others that only a logarithmic axis shows them all.
bool lie_far_apart(const std::vector<Series>& lines);

}  // namespace dynamic_icp::figures
