// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/selection.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "dynamic_icp/method/base/lanes.hpp"
#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp {
namespace {

constexpr std::ptrdiff_t kFewValues = 6;       // are left to the standard library
constexpr std::ptrdiff_t kUnevenly = 8;        // a part is small if it is less than this fraction
constexpr std::size_t kRoundsPerDoubling = 2;  // halves would take one; where many more are needed, the library helps

/// Brings the values that belong to the front there, and returns the end of them.
template <typename IsFront>
double* part_values(double* first, double* last, const IsFront& is_front) {
  double* end = first;
  for (double* at = first; at < last; ++at) {
    const double value = *at;
    *at = *end;
    *end = value;
    end += is_front(value) ? 1 : 0;
  }
  return end;
}

}  // namespace

void select_place(std::span<double> values, std::size_t place) {
  double* first = values.data();
  double* last = first + values.size();
  double* const at = first + place;
  auto rounds = kRoundsPerDoubling * static_cast<std::size_t>(std::bit_width(values.size()));
  for (; last - first > kFewValues && rounds > 0; --rounds) {
    const double a = *first;
    const double b = first[(last - first) / 2];
    const double c = last[-1];
    const double pivot = std::max(std::min(a, b), std::min(std::max(a, b), c));
    double* const rest = part_values(first, last, [pivot](double value) { return value < pivot; });
    if (at < rest) {
      last = rest;
      continue;
    }
    const bool is_small = rest - first < (last - first) / kUnevenly;
    first = rest;
    if (is_small) {  // many may be equal to the pivot
      first = part_values(rest, last, [pivot](double value) { return !(pivot < value); });
      if (at < first) {
        return;
      }
    }
  }
  std::nth_element(first, at, last);
}

std::size_t first_outside(std::span<const double> values, double low, double high) {
  std::size_t found = 0;
  simd::run([&]() DYNAMIC_ICP_KERNEL {
    constexpr std::size_t kTogether = 2 * simd::kLanes;
    const double* const value = values.data();
    const std::size_t n = values.size();
    const simd::Lanes lowest = low - simd::Lanes{};
    const simd::Lanes highest = high - simd::Lanes{};
    std::size_t i = 0;
    for (; i + kTogether <= n; i += kTogether) {
      simd::Lanes a, b;
      simd::load(a, value + i);
      simd::load(b, value + i + simd::kLanes);
      const simd::LaneMask inside = (a >= lowest) & (b >= lowest) & (a <= highest) & (b <= highest);
      if ((inside[0] & inside[1] & inside[2] & inside[3]) == 0) {
        break;
      }
    }
    while (i < n && value[i] >= low && value[i] <= high) {
      ++i;
    }
    found = i;
  });
  return found;
}

}  // namespace dynamic_icp
