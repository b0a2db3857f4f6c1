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

// Road users from bicycles to trailers, whatever they are called: the mean sizes that the authors of KITTI and nuScenes
// state of their classes lie within 25 % of these curves. People do not, nor do animals: see is_person_like.

/// Typical lengths grow with this power of width and height.
constexpr double kLengthPower = 0.75;

/// The length of what is so wide and high: 1.95 m (width height / m^2)^(3/4).
Belief typical_length(double width_m, double height_m);

/// What is longer than that is no body: 1.75 times the typical length.
double longest_length(double width_m, double height_m);

/// The width of what is so long: 0.41 of the length, and no more than the 2.5 m that roads allow.
Belief typical_width(double length_m);

/// The width of what is so high and of which neither length nor width are seen.
Belief typical_width_by_height(double height_m);

/// Whether what is seen of a body is as small as a person and as slow: nothing suggests that there is more of it.
bool is_person_like(double longest_side_m, double height_m, double speed_mps);

}  // namespace dynamic_icp::tracking
