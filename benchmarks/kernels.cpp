// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// dynamic-icp-kernels: how long each step takes on its own, beside the floor of the machine and, where their libraries
// are installed, beside others. See docs/performance.md; takes the options of Google Benchmark
// (--benchmark_filter=...).
#include <benchmark/benchmark.h>

#include "dynamic_icp/method/base/version.hpp"
#include "dynamic_icp/tools/benchmark/machine.hpp"

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  benchmark::AddCustomContext("machine", dynamic_icp::benchmark::describe_machine());
  benchmark::AddCustomContext("dynamic_icp", std::string(dynamic_icp::version()));
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
