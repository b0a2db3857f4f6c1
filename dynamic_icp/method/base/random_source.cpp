// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/random_source.hpp"

#include <cmath>
#include <numbers>

namespace dynamic_icp {
namespace {

/// The finaliser of SplitMix64: every bit of the input changes half of the bits of the output.
constexpr std::uint64_t scramble(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

constexpr std::uint64_t kGoldenRatio = 0x9E3779B97F4A7C15U;  // 2^64 / golden ratio: spreads consecutive counters

constexpr std::uint64_t hash(std::uint64_t key, std::uint64_t counter) {
  return scramble(scramble(key + kGoldenRatio) + kGoldenRatio * (counter + 1));
}

constexpr std::uint64_t kForkDomain = 0xD1B54A32D192ED03U;    // keeps forks apart from numbers drawn
constexpr std::uint64_t kNormalDomain = 0x8CB92BA72F3D8DD7U;  // and normal numbers apart from uniform ones

constexpr double to_unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }

}  // namespace

RandomSource::RandomSource(std::uint64_t seed) : key_(scramble(seed + kGoldenRatio)) {}

RandomSource RandomSource::fork(std::uint64_t index) const {
  RandomSource part(0);
  part.key_ = hash(key_ ^ kForkDomain, index);
  return part;
}

std::uint64_t RandomSource::bits(std::uint64_t stream) const { return hash(key_, stream); }

double RandomSource::uniform(std::uint64_t stream) const { return to_unit_interval(bits(stream)); }

double RandomSource::uniform(std::uint64_t stream, double low, double high) const {
  return low + (high - low) * uniform(stream);
}

double RandomSource::normal(std::uint64_t stream) const {
  // Box and Muller's transform of two uniform numbers, the first in (0, 1].
  const std::uint64_t key = key_ ^ kNormalDomain;
  const double radius = std::sqrt(-2.0 * std::log(1.0 - to_unit_interval(hash(key, 2 * stream))));
  return radius * std::cos(2.0 * std::numbers::pi * to_unit_interval(hash(key, 2 * stream + 1)));
}

}  // namespace dynamic_icp
