// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace dynamic_icp {

/// Random numbers that depend only on where they are used, not on what was drawn before: a source is a key, a fork is
/// the key of a part (a frame, a ray, a house), and a number is a hash of key and stream. Rays can therefore be
/// simulated in any order and by any number of threads, and adding one effect does not disturb the others.
///
/// The transforms are written out here: the distributions of the standard library differ between its vendors.
class RandomSource {
 public:
  explicit RandomSource(std::uint64_t seed);

  /// The source of the part called `index`; different parts are independent of each other.
  [[nodiscard]] RandomSource fork(std::uint64_t index) const;

  [[nodiscard]] std::uint64_t bits(std::uint64_t stream) const;                       ///< 64 random bits
  [[nodiscard]] double uniform(std::uint64_t stream) const;                           ///< in [0, 1)
  [[nodiscard]] double uniform(std::uint64_t stream, double low, double high) const;  ///< in [low, high)
  [[nodiscard]] double normal(std::uint64_t stream) const;                            ///< mean 0, standard deviation 1

 private:
  std::uint64_t key_;
};

}  // namespace dynamic_icp
