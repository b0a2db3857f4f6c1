// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/field_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace dynamic_icp::figures {
namespace {

// Shades for too much, strokes for too little: the sign is seen without colour.
constexpr std::array<const char*, 3> kTooMuch = {"░", "▒", "█"};
constexpr std::array<const char*, 3> kTooLittle = {"-", "=", "≡"};
constexpr const char* kAboutZero = "·";
constexpr const char* kUnknown = "?";

constexpr std::size_t kLabelWidth = 8;  // of an elevation

/// What a character of the picture stands for.
struct GlyphScale {
  double known_below_mps = 0.0;     ///< standard deviations above are unknown
  double most_mps = kMinError_mps;  ///< of what is known

  /// Where the shade `level` begins; it ends where the next one begins.
  [[nodiscard]] double begin_mps(std::size_t level) const {
    return most_mps * (2.0 * static_cast<double>(level) + 1.0) / (2.0 * kTooMuch.size() + 1.0);
  }

  [[nodiscard]] const char* glyph(double error_mps, double sigma_mps) const {
    if (!(sigma_mps <= known_below_mps)) {
      return kUnknown;
    }
    std::size_t levels = 0;
    while (levels < kTooMuch.size() && std::abs(error_mps) >= begin_mps(levels)) {
      ++levels;
    }
    return levels == 0 ? kAboutZero : (error_mps > 0.0 ? kTooMuch : kTooLittle)[levels - 1];
  }
};

GlyphScale scale_of(const FieldSummary& learned) {
  GlyphScale scale{std::max(kMinError_mps, learned.sizes.rms_mps)};
  const window::ErrorByDirection& cells = learned.cells;
  for (Eigen::Index row = 0; row < cells.error_mps.rows(); ++row) {
    for (Eigen::Index column = 0; column < cells.error_mps.cols(); ++column) {
      if (cells.sigma_mps(row, column) <= scale.known_below_mps) {
        scale.most_mps = std::max(scale.most_mps, std::abs(cells.error_mps(row, column)));
      }
    }
  }
  return scale;
}

/// Too much above too little, then what has no sign.
std::string legend_of(const GlyphScale& scale) {
  const int decimals = scale.most_mps < 0.02 ? 2 : 1;
  const auto cmps = [&](double value_mps) { return fmt::format("{:.{}f}", 100.0 * value_mps, decimals); };
  std::string too_much = fmt::format("{:>{}}", "cm/s", kLabelWidth - 1);
  std::string too_little(kLabelWidth - 1, ' ');
  for (std::size_t level = 0; level < kTooMuch.size(); ++level) {
    const bool is_last = level + 1 == kTooMuch.size();
    const std::size_t width = is_last ? 0 : 16;
    const std::string from = cmps(scale.begin_mps(level));
    const std::string to = cmps(is_last ? scale.most_mps : scale.begin_mps(level + 1));
    too_much += fmt::format("  {} {:<{}}", kTooMuch[level], fmt::format("{} to {}", from, to), width);
    too_little += fmt::format("  {} {:<{}}", kTooLittle[level], fmt::format("-{} to -{}", from, to), width);
  }
  return fmt::format("{}\n{}\n{:{}}  {} {:<16}  {} unknown: standard deviation above {}\n", too_much, too_little, "",
                     kLabelWidth - 1, kAboutZero, fmt::format("below {}", cmps(scale.begin_mps(0))), kUnknown,
                     cmps(scale.known_below_mps));
}

/// To a tenth, without the sign of a zero.
std::string degrees_text(double angle_deg) { return fmt::format("{:.1f}", std::round(10.0 * angle_deg) / 10.0 + 0.0); }

/// The azimuths of the left edge, the middle and the right edge below them.
std::string azimuth_axis(const ShownView& view, std::size_t columns) {
  const std::size_t side = columns / 3;
  return fmt::format("{:{}}{:<{}}{:^{}}{:>{}}\n", "", kLabelWidth, degrees_text(view.left_deg), side,
                     degrees_text(0.5 * (view.left_deg + view.right_deg)), columns + 2 - 2 * side,
                     degrees_text(view.right_deg), side);
}

}  // namespace

std::string field_text(const FieldSummary& learned) {
  const GlyphScale scale = scale_of(learned);
  const Eigen::MatrixXd& error_mps = learned.cells.error_mps;
  const double row_deg = (learned.view.top_deg - learned.view.bottom_deg) / static_cast<double>(error_mps.rows());
  std::string text = "error by elevation, up, and azimuth, to the right (deg)\n";
  for (Eigen::Index row = error_mps.rows() - 1; row >= 0; --row) {
    const double middle_deg = learned.view.bottom_deg + (static_cast<double>(row) + 0.5) * row_deg;
    text += fmt::format("{:>{}} |", degrees_text(middle_deg), kLabelWidth - 1);
    for (Eigen::Index column = error_mps.cols() - 1; column >= 0; --column) {  // azimuths ascend to the left
      text += scale.glyph(error_mps(row, column), learned.cells.sigma_mps(row, column));
    }
    text += "|\n";
  }
  text += azimuth_axis(learned.view, static_cast<std::size_t>(error_mps.cols())) + legend_of(scale);
  if (learned.cells.sigma_mps.minCoeff() > scale.known_below_mps) {
    // A sensor without error looks like one of which nothing was learned.
    text += "The RMS of the error is smaller than its standard deviation everywhere.\n";
  }
  return text;
}

}  // namespace dynamic_icp::figures
