// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace dynamic_icp::simd {

/// What the machine can do beyond the baseline this library is built for.
enum class Level {
  kBaseline,  ///< what every machine of the architecture has: SSE2 on x86-64, NEON on arm64
  kAvx2,
};

/// The levels that kernels are built for and this machine has, baseline first.
std::span<const Level> available_levels();

/// The best of them; "baseline" in the environment variable DYNAMIC_ICP_SIMD holds it down. Decided once.
Level level();

/// Marks the call operator of a kernel, `[&]() DYNAMIC_ICP_KERNEL { ... }`: its loops are compiled anew for each level.
#define DYNAMIC_ICP_KERNEL __attribute__((always_inline))

/// Marks a function that a kernel calls.
#define DYNAMIC_ICP_INLINE inline __attribute__((always_inline))

/// Stands before the loop over the lanes of a sum, which is to become vectors and not a row of single steps.
#if defined(__clang__)
#define DYNAMIC_ICP_LANE_LOOP
#else
#define DYNAMIC_ICP_LANE_LOOP _Pragma("GCC unroll 1")
#endif

#if defined(__x86_64__)
template <class Kernel>
__attribute__((noinline, target("avx2"))) void run_avx2(const Kernel& kernel) {
  kernel();
}
#endif

template <class Kernel>
__attribute__((noinline)) void run_baseline(const Kernel& kernel) {
  kernel();
}

/// Runs a kernel with the instructions of a level that the machine has.
///
/// A kernel is plain loops over arrays that the compiler turns into vectors, with sums kept in a fixed number of lanes.
/// The order of all operations is then written in the source, and as multiplications and additions are never fused, the
/// results are the same bits at every level.
template <class Kernel>
void run(const Kernel& kernel, Level at = level()) {
#if defined(__x86_64__)
  if (at == Level::kAvx2) {
    run_avx2(kernel);
    return;
  }
#endif
  static_cast<void>(at);
  run_baseline(kernel);
}

}  // namespace dynamic_icp::simd
