// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

#include <benchmark/benchmark.h>

namespace dynamic_icp::kernels {

// Bytes of the columns that a kernel must read or write at least once.
inline constexpr std::size_t kPointBytes = 24;  ///< x, y, z
inline constexpr std::size_t kRowBytes = 60;    ///< of a Scan without times: point, direction, Doppler, record

/// The least that one iteration must do, whatever the program looks like: estimates from the equations, good to a
/// factor of two. Over the figures of the floor (floor.cpp) they say how long it takes at best; benchmarks/summary.py
/// does that. 0: not stated.
struct Work {
  std::size_t items = 0;       ///< what is worked on: points, pairs, queries
  std::size_t bytes = 0;       ///< of input and output, read or written in order
  std::size_t lines = 0;       ///< cache lines met at random places
  std::size_t operations = 0;  ///< multiplications, additions and comparisons of doubles
};

inline void count(benchmark::State& state, const Work& work) {
  const auto iterations = static_cast<std::int64_t>(state.iterations());
  state.SetItemsProcessed(iterations * static_cast<std::int64_t>(work.items));
  state.SetBytesProcessed(iterations * static_cast<std::int64_t>(work.bytes));
  state.counters["items"] = static_cast<double>(work.items);
  state.counters["bytes"] = static_cast<double>(work.bytes);
  state.counters["lines"] = static_cast<double>(work.lines);
  state.counters["operations"] = static_cast<double>(work.operations);
}

/// The same when each item needs this much.
inline void count_each(benchmark::State& state, std::size_t items, const Work& each) {
  count(state, {items, items * each.bytes, items * each.lines, items * each.operations});
}

/// ceil(log2(n)): steps down a tree over n leaves.
constexpr std::size_t levels_over(std::size_t n) {
  std::size_t levels = 0;
  while ((std::size_t{1} << levels) < n) {
    ++levels;
  }
  return levels;
}

/// The argument for the number of threads. Time is that of the clock on the wall, CPU that of all threads.
inline void one_and_two_threads(benchmark::internal::Benchmark* kernel) {
  kernel->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMicrosecond);
}

/// Sensor (0 small, 1 usual, 2 large) and threads.
inline void sensors_and_threads(benchmark::internal::Benchmark* kernel) {
  kernel->ArgNames({"sensor", "threads"})->UseRealTime()->MeasureProcessCPUTime()->Unit(benchmark::kMicrosecond);
  kernel->ArgsProduct({{0, 1, 2}, {1, 2}});
}

/// Sensor (0 small, 1 usual, 2 large), for kernels of one thread.
inline void all_sensors(benchmark::internal::Benchmark* kernel) {
  kernel->ArgName("sensor")->Arg(0)->Arg(1)->Arg(2)->UseRealTime()->MeasureProcessCPUTime()->Unit(
      benchmark::kMicrosecond);
}

}  // namespace dynamic_icp::kernels
