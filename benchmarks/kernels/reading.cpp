// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <string>

#include <unistd.h>

#include "dynamic_icp/recording/formats/point_records.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "benchmarks/kernels/counters.hpp"

namespace dynamic_icp::kernels {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPoints = 100'000;
constexpr std::size_t kDoubleBytes = 8;

/// From the memory that the system keeps files in: what a disk takes comes on top.
void read_records(benchmark::State& state, const formats::RecordLayout& layout) {
  const fs::path path = fs::temp_directory_path() / ("dynamic_icp_kernels-" + std::to_string(::getpid()) + ".bin");
  formats::write_whole_file(path, std::string(kPoints * layout.bytes, '\x3f'));
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(formats::read_points(path, layout));
  }
  fs::remove(path);
  const bool has_times = layout.time_type != formats::RecordTime::kNone;
  count_each(state, kPoints, {.bytes = layout.bytes + kPointBytes + (has_times ? 2 : 1) * kDoubleBytes});
  state.counters["file_bytes"] =
      benchmark::Counter(static_cast<double>(kPoints * layout.bytes), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK_CAPTURE(read_records, xyzd, formats::kXyzd)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(read_records, aeva25, formats::kAeva25)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(read_records, aeva29, formats::kAeva29)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(read_records, boreas40, formats::kBoreas40)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
