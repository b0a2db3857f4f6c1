// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/odometry/config.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

constexpr std::size_t kRayBytes = 32;  // direction and Doppler

/// The paper's regression, on the thinned scan, from the true velocity but 0.5 m/s.
void doppler_regression(benchmark::State& state) {
  const KnownScan& known = known_scan();
  const Workers workers(static_cast<int>(state.range(0)));
  const auto config = odometry::PaperConfig{}.ego_motion.regression;
  const Eigen::Vector3d prior = known.velocity_sensor + Eigen::Vector3d(0.5, 0.0, 0.0);
  int rounds = 0;
  for ([[maybe_unused]] auto _ : state) {
    rounds = ego_motion::estimate_velocity(known.thinned, prior, config, workers).iterations;
  }
  state.counters["rounds"] = rounds;
  // In each round every row has its residual, weight, and part of 3 x 3 normal equations.
  const auto passes = static_cast<std::size_t>(rounds);
  count_each(state, known.thinned.size(), {.bytes = kRayBytes * passes, .operations = 30 * passes});
}
BENCHMARK(doppler_regression)->Apply(one_and_two_threads);

/// On the whole scan, with a prior of the velocity as the filter gives it, and without as in the first scan.
void consensus_regression(benchmark::State& state) {
  const KnownScan& known = known_scan();
  const Workers workers(static_cast<int>(state.range(1)));
  const auto config = odometry::WindowOdometryConfig{}.ego_motion.consensus;
  ego_motion::EgoPrior prior;
  prior.has_velocity = state.range(0) != 0;
  if (prior.has_velocity) {
    prior.mean.head<3>() = known.velocity_sensor + Eigen::Vector3d(0.1, 0.0, 0.0);
    prior.covariance.diagonal() << 0.04, 0.04, 0.04, 1.0, 1.0, 1.0, 0.01;
  }
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(ego_motion::estimate_velocity(known.whole, prior, config, workers));
  }
  // Sorting into cells and a few rounds of 7 x 7 normal equations over the winner's points. The votes come on top.
  constexpr std::size_t kRounds = 4;
  count_each(state, known.whole.size(),
             {.bytes = (kRounds + 1) * kRayBytes + kPointBytes, .lines = 2, .operations = kRounds * 60});
}
BENCHMARK(consensus_regression)
    ->ArgNames({"prior", "threads"})
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMicrosecond);

void velocity_filter(benchmark::State& state) {
  const KnownScan& known = known_scan();
  const auto config = odometry::WindowOdometryConfig{}.ego_motion.filter;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(ego_motion::dynamic_mask(
        known.whole, ego_motion::compensated_doppler(known.whole, known.velocity_sensor), config));
  }
  count_each(state, known.whole.size(), {.bytes = kRayBytes + kPointBytes + 17, .operations = 14});
}
BENCHMARK(velocity_filter)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
