// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include "dynamic_icp/method/base/simd.hpp"

namespace dynamic_icp::simd {

// Four numbers at a time, for kernels whose loops the compiler does not turn into vectors by itself. Operators work
// lane by lane; a comparison gives -1 or 0. Always four, whatever the machine has: sums are the same bits everywhere.
// Lanes are passed by reference, because how to pass them by value depends on the machine.

inline constexpr std::size_t kLanes = 4;
using Lanes = double __attribute__((vector_size(32)));
using LaneMask = long long __attribute__((vector_size(32)));

/// Lanes at any address of a double. A typedef, because clang ignores the alignment of an alias-declaration.
typedef double LanesInMemory __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(LanesInMemory) == alignof(double), "lanes are loaded from addresses of single numbers");

DYNAMIC_ICP_INLINE void load(Lanes& lanes, const double* from) {
  lanes = *reinterpret_cast<const LanesInMemory*>(from);
}
DYNAMIC_ICP_INLINE void store(double* to, const Lanes& lanes) { *reinterpret_cast<LanesInMemory*>(to) = lanes; }

/// The three columns of four rows that follow each other.
DYNAMIC_ICP_INLINE void load_columns(Lanes& x, Lanes& y, Lanes& z, const double* rows) {
  typedef double PairInMemory __attribute__((vector_size(16), aligned(8), may_alias));
  const auto pairs = [rows](std::size_t first, std::size_t second, Lanes& lanes) DYNAMIC_ICP_KERNEL {
    lanes = __builtin_shufflevector(*reinterpret_cast<const PairInMemory*>(rows + first),
                                    *reinterpret_cast<const PairInMemory*>(rows + second), 0, 1, 2, 3);
  };
  Lanes a, b, c;
  pairs(0, 6, a);   // x0 y0 x2 y2
  pairs(2, 8, b);   // z0 x1 z2 x3
  pairs(4, 10, c);  // y1 z1 y3 z3
  x = __builtin_shufflevector(a, b, 0, 5, 2, 7);
  y = __builtin_shufflevector(a, c, 1, 4, 3, 6);
  z = __builtin_shufflevector(b, c, 0, 5, 2, 7);
}

// Bits instead of a ?: b : c, which not every machine has for lanes.

/// The larger of two lanes each, `b` where they cannot be compared.
DYNAMIC_ICP_INLINE void keep_larger(Lanes& a, const Lanes& b) {
  const LaneMask a_is_larger = a > b;
  a = (Lanes)(((LaneMask)a & a_is_larger) | ((LaneMask)b & ~a_is_larger));
}

/// The smaller of two lanes each, `b` where they cannot be compared.
DYNAMIC_ICP_INLINE void keep_smaller(Lanes& a, const Lanes& b) {
  const LaneMask a_is_smaller = a < b;
  a = (Lanes)(((LaneMask)a & a_is_smaller) | ((LaneMask)b & ~a_is_smaller));
}

/// Zero where the mask is 0.
DYNAMIC_ICP_INLINE void keep_where(Lanes& a, const LaneMask& mask) { a = (Lanes)((LaneMask)a & mask); }

/// The sum of the lanes, in one order.
DYNAMIC_ICP_INLINE double sum(const Lanes& lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }

}  // namespace dynamic_icp::simd
