// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <optional>

#include "dynamic_icp/method/mapping/pose_search.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/registration/align.hpp"

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

/// Two scans, one after the other, as preset paper aligns them.
struct Pair {
  Pair() : tree(target_scan.points()) {
    const KnownScan& last = known_scan(Sensor::kUsual, 0);
    const KnownScan& now = known_scan(Sensor::kUsual, 1);
    normals = preprocess::estimate_normals(target_scan.points(), tree, preprocess::NormalsConfig{}, Workers(0));
    T_true = now.T_world_sensor.inverse() * last.T_world_sensor;
    T_start.translation() = -0.1 * last.velocity_sensor;
  }

  const Scan& source_scan = known_scan(Sensor::kUsual, 0).still;
  const Scan& target_scan = known_scan(Sensor::kUsual, 1).thinned;
  spatial::KdTree tree;
  preprocess::Normals normals;
  Eigen::Isometry3d T_true = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_start = Eigen::Isometry3d::Identity();

  [[nodiscard]] registration::Target target() const { return {target_scan, tree, normals.vectors, normals.valid}; }
};

const Pair& pair() {
  static const Pair made;
  return made;
}

void correspondences(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  for ([[maybe_unused]] auto _ : state) {
    registration::CorrespondenceSearch search(pair().source_scan, pair().target(), registration::Gate{0.3}, true,
                                              workers);
    benchmark::DoNotOptimize(search.find(pair().T_true));
  }
  // A search as in kd_tree_nearest, for the two nearest points.
  const std::size_t levels = levels_over(pair().tree.leaf_count());
  count_each(state, pair().source_scan.size(),
             {.bytes = kPointBytes + sizeof(registration::Correspondence),
              .lines = levels + sizeof(spatial::KdTree::Leaf) / 64,
              .operations = 12 * levels + 9 * spatial::KdTree::kLeafSize + 15});
}
BENCHMARK(correspondences)->Apply(one_and_two_threads);

void linearise(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const auto objective = registration::dynamic_icp_objective(odometry::PaperConfig{}.registration);
  registration::CorrespondenceSearch search(pair().source_scan, pair().target(), registration::Gate{0.3}, true,
                                            workers);
  const registration::Correspondences found = search.find(pair().T_true);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        registration::linearise({{pair().source_scan}, pair().target(), found}, pair().T_true, objective, 0, workers));
  }
  // Two residuals, each with Jacobian and weight (40), normal equations and score of six unknowns (lower halves: 100).
  // The rows of the target lie anywhere.
  count_each(state, found.pairs.size(),
             {.bytes = kPointBytes + 32 + sizeof(registration::Correspondence), .lines = 4, .operations = 2 * 140});
}
BENCHMARK(linearise)->Apply(one_and_two_threads);

void solve(benchmark::State& state) {
  const Workers workers(1);
  const auto objective = registration::dynamic_icp_objective(odometry::PaperConfig{}.registration);
  registration::CorrespondenceSearch search(pair().source_scan, pair().target(), registration::Gate{0.3}, true,
                                            workers);
  const registration::Linearisation linear = registration::linearise(
      {{pair().source_scan}, pair().target(), search.find(pair().T_true)}, pair().T_true, objective, 0, workers);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(estimation::solve(linear.equations, 20.0, 1e-12));
  }
  // The eigenvectors of a symmetric 6 x 6 matrix: some 9 n^3.
  count(state, {.items = 1, .operations = 2000});
}
BENCHMARK(solve)->UseRealTime();

/// The whole alignment of preset paper, the kd-tree and the normals excluded.
void align_scans(benchmark::State& state) {
  const Workers workers(static_cast<int>(state.range(0)));
  const auto config = odometry::PaperConfig{}.registration;
  int rounds = 0;
  for ([[maybe_unused]] auto _ : state) {
    rounds = registration::align(pair().source_scan, pair().target(), pair().T_start, config, workers).iterations;
  }
  state.counters["rounds"] = rounds;
  // Each round as in `linearise`; one search in all, where every answer is remembered.
  const auto passes = static_cast<std::size_t>(rounds);
  count_each(state, pair().source_scan.size(),
             {.bytes = passes * 3 * kPointBytes, .lines = passes * 5, .operations = passes * 300 + 300});
}
BENCHMARK(align_scans)->Apply(one_and_two_threads);

/// As the second scan in a map: its place to some cm, its rotation to 3 degrees.
void search_pose(benchmark::State& state) {
  const KnownScan& scan = known_scan(Sensor::kUsual, kScans - 1);
  const Workers workers(static_cast<int>(state.range(0)));
  mapping::PosePrior prior;
  prior.R_map_sensor = Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitZ()) * scan.T_world_sensor.linear();
  prior.rotation_sigma_rad = 0.05;
  prior.displacement_fixed = scan.T_world_sensor.translation() + Eigen::Vector3d(0.01, -0.01, 0.0);
  prior.position_sigma_m = 0.05;
  prior.sweep.velocity = scan.velocity_sensor;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(mapping::search_pose(scan.still, known_map(), prior, workers));
  }
  count_each(state, scan.still.size(), {.bytes = kPointBytes, .lines = 1 + sizeof(mapping::Patch) / 64});
}
BENCHMARK(search_pose)->Apply(one_and_two_threads);

}  // namespace
}  // namespace dynamic_icp::kernels
