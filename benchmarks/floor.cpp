// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What the machine can do at best: memory, arithmetic and threads. A kernel is explained when its bytes or operations
// over these figures come near its time.
#include <chrono>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include <Eigen/Core>

#include "dynamic_icp/method/base/parallel.hpp"

#include "benchmarks/kernels/counters.hpp"

namespace dynamic_icp::kernels {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr std::size_t kStreamBytes = 128 * kMiB;  // beyond all caches
constexpr std::size_t kStreamBlock = kMiB / sizeof(std::uint64_t);
constexpr std::size_t kLineBytes = 64;

void floor_memory_read(benchmark::State& state) {
  const std::vector<std::uint64_t> words(kStreamBytes / sizeof(std::uint64_t), 1);
  const Workers workers(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        workers.sum_blocks(words.size(), kStreamBlock, std::uint64_t{0}, [&](std::size_t begin, std::size_t end) {
          std::uint64_t sum = 0;
          for (std::size_t i = begin; i < end; ++i) {
            sum += words[i];
          }
          return sum;
        }));
  }
  count(state, {.items = words.size(), .bytes = kStreamBytes});
}
BENCHMARK(floor_memory_read)->Apply(one_and_two_threads);

void floor_memory_copy(benchmark::State& state) {
  const std::vector<std::uint64_t> from(kStreamBytes / sizeof(std::uint64_t), 1);
  std::vector<std::uint64_t> to(from.size(), 2);
  const Workers workers(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    workers.for_blocks(from.size(), kStreamBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
      std::memcpy(&to[begin], &from[begin], (end - begin) * sizeof(std::uint64_t));
    });
    benchmark::ClobberMemory();
  }
  count(state, {.items = from.size(), .bytes = 2 * kStreamBytes});
}
BENCHMARK(floor_memory_copy)->Apply(one_and_two_threads);

/// One cache line of a table.
struct alignas(kLineBytes) Line {
  std::uint64_t next = 0;
};

/// Lines that name each other in one random cycle (Sattolo).
std::vector<Line> cycle_of(std::size_t bytes) {
  std::vector<std::uint64_t> order(bytes / kLineBytes);
  std::iota(order.begin(), order.end(), std::uint64_t{0});
  std::mt19937_64 random(31);
  for (std::size_t i = order.size() - 1; i > 0; --i) {
    std::swap(order[i], order[random() % i]);
  }
  std::vector<Line> lines(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    lines[i].next = order[i];
  }
  return lines;
}

constexpr std::size_t kSteps = 1 << 16;

/// Each step must wait for the one before: the time of one is the latency.
void floor_random_latency(benchmark::State& state) {
  const std::vector<Line> lines = cycle_of(static_cast<std::size_t>(state.range(0)) * kMiB);
  std::uint64_t at = 0;
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < kSteps; ++i) {
      at = lines[at].next;
    }
    benchmark::DoNotOptimize(at);
  }
  count_each(state, kSteps, {.bytes = kLineBytes, .lines = 1});
}
BENCHMARK(floor_random_latency)
    ->ArgName("MiB")
    ->Arg(2)
    ->Arg(32)
    ->Arg(256)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

/// The places are known beforehand: as many lines are under way as the processor can ask for.
void floor_random_throughput(benchmark::State& state) {
  const std::vector<Line> lines = cycle_of(static_cast<std::size_t>(state.range(0)) * kMiB);
  std::mt19937_64 random(32);
  std::vector<std::uint32_t> places(kSteps);
  for (std::uint32_t& place : places) {
    place = static_cast<std::uint32_t>(random() % lines.size());
  }
  std::size_t shift = 0;
  for ([[maybe_unused]] auto _ : state) {
    std::uint64_t sum = 0;
    for (const std::uint32_t place : places) {
      sum += lines[(place + shift) % lines.size()].next;
    }
    shift += 7919;  // other lines every time
    benchmark::DoNotOptimize(sum);
  }
  count_each(state, kSteps, {.bytes = kLineBytes, .lines = 1});
}
BENCHMARK(floor_random_throughput)
    ->ArgName("MiB")
    ->Arg(2)
    ->Arg(32)
    ->Arg(256)
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

/// Multiplications and additions of doubles, not fused, in vectors as wide as the build allows, enough of them at a
/// time that none waits for another. Items are operations.
void floor_arithmetic(benchmark::State& state) {
  constexpr int kLanes = 20;
  constexpr std::size_t kRounds = 4096;
  Eigen::Array<double, kLanes, 1> x = Eigen::Array<double, kLanes, 1>::LinSpaced(0.5, 1.5);
  double factor = 0.999;
  double step = 0.001;
  benchmark::DoNotOptimize(factor);
  benchmark::DoNotOptimize(step);
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < kRounds; ++i) {
      x = x * factor + step;
    }
    benchmark::DoNotOptimize(x);
  }
  count(state, {.items = kRounds * 2 * kLanes, .operations = kRounds * 2 * kLanes});
}
BENCHMARK(floor_arithmetic)->UseRealTime()->Unit(benchmark::kMicrosecond);

/// A loop over so many empty blocks, again and again: what a parallel loop costs at least.
void floor_empty_loop(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const auto blocks = static_cast<std::size_t>(state.range(1));
  for ([[maybe_unused]] auto _ : state) {
    workers.for_blocks(blocks, 1, [](std::size_t block, std::size_t, std::size_t) { benchmark::DoNotOptimize(block); });
  }
  count(state, {.items = blocks});
}
BENCHMARK(floor_empty_loop)
    ->ArgNames({"threads", "blocks"})
    ->ArgsProduct({{1, 2}, {2, 64, 4096}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

/// The same after a pause of a millisecond, in which the helpers have fallen asleep.
void floor_wake_up(benchmark::State& state) {
  using Clock = std::chrono::steady_clock;
  const Workers workers(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const Clock::time_point begin = Clock::now();
    workers.for_blocks(2, 1, [](std::size_t block, std::size_t, std::size_t) { benchmark::DoNotOptimize(block); });
    state.SetIterationTime(std::chrono::duration<double>(Clock::now() - begin).count());
  }
  count(state, {.items = 1});
}
BENCHMARK(floor_wake_up)
    ->ArgName("threads")
    ->Arg(1)
    ->Arg(2)
    ->Iterations(100)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
