// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dynamic_icp::drawing {

struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Rgb&) const = default;
};

/// "#rrggbb".
std::string css(Rgb colour);

/// The background a colour is meant for.
enum class Ground { kLight, kDark };

/// The colour of a signed quantity: blue at -1, grey at 0, red at +1, clamped outside. The grey is close to the
/// background and both ends stand out from it equally, so that the large magnitudes catch the eye. Blue and red stay
/// apart for every common kind of colour blindness. NaN gives the grey.
Rgb diverging_colour(double value, Ground ground);

/// `count` (odd) colours of `diverging_colour` in equal steps from -1 to +1; the middle one is the grey of 0.
std::vector<std::string> diverging_bins(std::size_t count, Ground ground);

/// The bin of `value` in [-limit, limit] among `count` of them; values outside go to the outermost bins, NaN and a
/// limit of zero to the middle one.
std::size_t diverging_bin(double value, double limit, std::size_t count);

/// The colour of a quantity from 0 to 1, clamped outside: dark blue over green to light yellow, ever lighter.
Rgb sequential_colour(double value);

/// A colour between two: `a` at 0, `b` at 1.
Rgb mix(Rgb a, Rgb b, double share);

/// The colour that CSS calls "#rrggbb"; black for anything else.
Rgb rgb(const std::string& css);

/// Colours for kinds and objects, in the order in which they should be used; they can be distinguished by colour-blind
/// readers (the set of Okabe and Ito, lightened or darkened for the background).
const std::vector<std::string>& categorical_colours(Ground ground);

}  // namespace dynamic_icp::drawing
