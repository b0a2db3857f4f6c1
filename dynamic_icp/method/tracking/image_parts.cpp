// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/tracking/image_parts.hpp"

#include <algorithm>
#include <cmath>

#include "dynamic_icp/method/base/simd.hpp"
#include "dynamic_icp/method/tracking/flags.hpp"
#include "dynamic_icp/method/tracking/image_cells.hpp"

namespace dynamic_icp::tracking {
namespace {

constexpr double kAround_m = 0.01;  // a patch that comes so near to the axis of the sensor may be anywhere
constexpr double kMargin = 1.0;     // columns and rows: more than rounding makes of them

DYNAMIC_ICP_INLINE std::int16_t small(double value) { return static_cast<std::int16_t>(static_cast<int>(value)); }

}  // namespace

void ImageParts::reset(const ScanPatches& patches) {
  const std::size_t size = patches.blocks().size() * PatchBlock::kPatches;
  for (auto* const values : {&first_column_, &last_column_, &lowest_row_, &highest_row_}) {
    values->resize(size);
  }
  is_seen_.assign(size, 1);
  is_found_.resize(size);
  found_.reserve(size);
  std::size_t begin = 0;
  for (const PatchBlock& block : patches.blocks()) {
    std::fill_n(is_seen_.begin() + static_cast<std::ptrdiff_t>(begin), block.count(), std::uint8_t{0});
    simd::run([&]() DYNAMIC_ICP_KERNEL {
      const PatchBlock::Bounds& at = block.bounds();
      std::int16_t* const first = &first_column_[begin];
      std::int16_t* const last = &last_column_[begin];
      std::int16_t* const lowest = &lowest_row_[begin];
      std::int16_t* const highest = &highest_row_[begin];
      for (std::size_t i = 0; i < PatchBlock::kPatches; ++i) {
        // The corners of the box with the least and the greatest azimuth, and its distances from the axis.
        const bool is_around = !(at.along_low[i] > kAround_m);
        const double nearest = is_around ? kAround_m : at.along_low[i];
        const double right = at.across_low[i] < 0.0 ? nearest : at.along_high[i];
        const double left = at.across_high[i] > 0.0 ? nearest : at.along_high[i];
        const double from =
            turn_measure(at.x[i] * right - at.y[i] * at.across_low[i], at.y[i] * right + at.x[i] * at.across_low[i]);
        const double to =
            turn_measure(at.x[i] * left - at.y[i] * at.across_high[i], at.y[i] * left + at.x[i] * at.across_high[i]);
        const double before = std::abs(at.across_low[i]);
        const double beyond = std::abs(at.across_high[i]);
        const double far_across = before > beyond ? before : beyond;
        const double near_across = before > beyond ? beyond : before;
        const bool is_aside = at.across_low[i] * at.across_high[i] > 0.0;
        const double aside = is_aside ? near_across : 0.0;
        const double near_m = std::sqrt(nearest * nearest + aside * aside);
        const double far_m = std::sqrt(at.along_high[i] * at.along_high[i] + far_across * far_across);
        const double bottom = image_row(at.low[i], at.low[i] < 0.0 ? near_m : far_m) - kMargin;
        const double top = image_row(at.high[i], at.high[i] > 0.0 ? near_m : far_m) + kMargin;
        const double begins = from * (0.25 * kImageColumns) - kMargin;
        const double shift = begins < 0.0 ? 1.0 * kImageColumns : 0.0;
        const double ends = (to < from ? 4.0 + to : to) * (0.25 * kImageColumns) + kMargin;
        first[i] = small(is_around ? 0.0 : begins + shift);
        last[i] = small(is_around ? 2.0 * kImageColumns : ends + shift);
        lowest[i] = static_cast<std::int16_t>(is_around ? 0 : row_in_image(bottom));
        highest[i] = static_cast<std::int16_t>(is_around ? kImageRows - 1 : row_in_image(top));
      }
    });
    begin += PatchBlock::kPatches;
  }
}

const std::vector<std::uint32_t>& ImageParts::find_in(const ImagePart& part, std::uint8_t is_seen) {
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    const std::size_t n = is_seen_.size();
    const auto from = static_cast<std::int16_t>(part.first_column);
    const auto to = static_cast<std::int16_t>(part.last_column);
    const auto from_again = static_cast<std::int16_t>(part.first_column + kImageColumns);
    const auto bottom = static_cast<std::int16_t>(part.lowest_row);
    const auto top = static_cast<std::int16_t>(part.highest_row);
    const std::int16_t* const first = first_column_.data();
    const std::int16_t* const last = last_column_.data();
    const std::int16_t* const lowest = lowest_row_.data();
    const std::int16_t* const highest = highest_row_.data();
    const std::uint8_t* const seen = is_seen_.data();
    std::uint8_t* const found = is_found_.data();
    const std::uint8_t wanted = is_seen;
    for (std::size_t i = 0; i < n; ++i) {
      const bool in_columns = ((first[i] <= to) & (last[i] >= from)) | (last[i] >= from_again);
      const bool in_rows = (lowest[i] <= top) & (highest[i] >= bottom);
      found[i] = (in_columns & in_rows & (seen[i] == wanted)) ? 1 : 0;
    }
  });
  found_.clear();
  visit_flagged(is_found_, 0, is_found_.size(),
                [&](std::size_t patch) { found_.push_back(static_cast<std::uint32_t>(patch)); });
  return found_;
}

}  // namespace dynamic_icp::tracking
