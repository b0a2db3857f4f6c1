// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

// Saved states as somebody makes them who wants harm: changed, with a checksum that fits.
namespace dynamic_icp::crafted {

/// Changes a saved state without its checksum in one place: one byte, four or eight, into random ones or into a number
/// that is an edge of its type. All choices come from the two numbers.
class StateEdit {
 public:
  explicit StateEdit(std::uint64_t bits, std::uint64_t value) : bits_(bits), value_(value) {}

  void apply(std::string& state) const {
    if (state.size() < 2 * sizeof(std::uint64_t)) {
      return;
    }
    const std::size_t bytes = std::array<std::size_t, 4>{1, 4, 8, 8}[bits_ % 4];
    const std::size_t room = state.size() - bytes + 1;
    // Small parts stand beside large ones at the begin and the end.
    const std::uint64_t drawn = bits_ >> 8U;
    const std::uint64_t near = drawn >> (8U * (bits_ / 4 % 4));
    const std::size_t from_begin = near % room;
    const std::size_t at = bits_ / 16 % 2 == 0 ? from_begin : room - 1 - from_begin;
    const std::uint64_t number = bits_ / 32 % 2 == 0 ? value_ : edge(value_ % kEdges);
    std::memcpy(state.data() + at, &number, bytes);
  }

 private:
  static constexpr std::size_t kEdges = 14;

  static std::uint64_t edge(std::uint64_t which) {
    const auto bits_of = [](double number) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &number, sizeof bits);
      return bits;
    };
    using Limits = std::numeric_limits<double>;
    const std::array<std::uint64_t, kEdges> edges = {0,
                                                     1,
                                                     2,
                                                     127,
                                                     0xffffffffU,
                                                     0x7fffffffU,
                                                     ~std::uint64_t{0},
                                                     std::uint64_t{1} << 62U,
                                                     bits_of(Limits::quiet_NaN()),
                                                     bits_of(-Limits::infinity()),
                                                     bits_of(1e300),
                                                     bits_of(-1e9),
                                                     bits_of(-0.5),
                                                     bits_of(1e-300)};
    return edges.at(which);
  }

  std::uint64_t bits_;
  std::uint64_t value_;
};

/// Edits are of what lies before it; StateArchive::seal appends another one.
inline void remove_checksum(std::string& state) { state.resize(state.size() - sizeof(std::uint64_t)); }

}  // namespace dynamic_icp::crafted
