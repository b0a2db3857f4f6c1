// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp::tracking {

/// An expected length, m, and how far it may be off, m^2.
struct Belief {
  double mean = 0.0;
  double variance = 0.0;
};

/// The Gaussian belief once the length is known to be at least `least`: the most likely length, and the mean square of
/// the difference from it.
Belief at_least(const Belief& belief, double least);

// Road users from bicycles to trailers, whatever they are called: curves through the mean sizes of the classes of
// KITTI, nuScenes, ONCE, Lyft and Waymo, and of cars and vans as their makers state them. People do not lie near them,
// nor do animals: see is_person_sized.

/// The length of what is so wide and high: 2.4 m (width / m)^0.9 exp(0.35 ln^2(height / m)), by least squares of the
/// logarithms. What is lower than 1 m counts as so high.
Belief typical_length(double width_m, double height_m);

/// How much longer the typical length is of what is higher, m per m: its derivative by the height.
double length_per_height(double width_m, double height_m);

/// What is longer than that is no body: 1.75 times the typical length.
double longest_length(double width_m, double height_m);

/// The width of what is so long: 0.41 of the length, and no more than the 2.5 m that roads allow.
Belief typical_width(double length_m);

/// The width of what is so high and of which neither length nor width are seen.
Belief typical_width_by_height(double height_m);

/// The height of what is seen up to so far above the ground, where the upper edge of the field of view cuts it off:
/// anywhere from there up to the 4 m that roads allow.
Belief height_beyond(double seen_m);

/// Whether what is seen of a body is longer than 5 m and higher than vans are: a lorry, a bus or a trailer, which have
/// flat sides and differ little in width.
bool is_lorry_sized(double length_m, double height_m);

/// Whether what is seen of a body is as small as a person, and whether it is as slow: if both, nothing suggests that
/// there is more of it.
bool is_person_sized(double longest_side_m, double height_m);
bool is_walking_speed(double speed_mps);

}  // namespace dynamic_icp::tracking
