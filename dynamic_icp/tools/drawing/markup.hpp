// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace dynamic_icp::drawing {

/// `text` as it must stand in the text or in a quoted attribute of SVG and HTML: the five characters of markup become
/// entities; bytes that are no UTF-8 and control characters, which XML forbids, become U+FFFD.
std::string escape_markup(std::string_view text);

/// `value` with at most `decimals` decimals, no trailing zeros, no "-0", no exponent: "12.5", "-3", "0". Numbers that
/// are not finite come out as "0": the drawing functions leave such elements out before they get here.
std::string compact_number(double value, int decimals = 2);

}  // namespace dynamic_icp::drawing
