// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace dynamic_icp::report {

/// Appends the unsigned number to `bytes`, its lowest byte first.
template <class Unsigned>
void append_little_endian(std::string& bytes, Unsigned value) {
  static_assert(std::is_unsigned_v<Unsigned>);
  for (std::size_t k = 0; k < sizeof value; ++k) {
    bytes.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * k) & 0xff));
  }
}

inline void append_float32(std::string& bytes, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  append_little_endian(bytes, bits);
}

inline void append_float64(std::string& bytes, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  append_little_endian(bytes, bits);
}

/// Appends each value of a column as its difference to the one before, modulo the range of `Unsigned`; the first one as
/// the difference to 0.
template <class Unsigned>
void append_differences(std::string& bytes, const std::vector<std::int64_t>& column) {
  std::int64_t before = 0;
  for (const std::int64_t value : column) {
    append_little_endian(bytes, static_cast<Unsigned>(value - before));
    before = value;
  }
}

}  // namespace dynamic_icp::report
