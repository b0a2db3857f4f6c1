// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Open3D beside our own steps, on the same scans; as many threads as OMP_NUM_THREADS says (CPU over time shows how many
// worked).
#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/pipelines/registration/GeneralizedICP.h>
#include <open3d/pipelines/registration/Registration.h>
#include <open3d/pipelines/registration/TransformationEstimation.h>

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

using open3d::geometry::PointCloud;
namespace icp = open3d::pipelines::registration;

constexpr double kVoxel_m = 0.3;
constexpr double kRadius_m = 2.0;
constexpr int kNeighbours = 30;

Sensor sensor_of(const benchmark::State& state) { return static_cast<Sensor>(state.range(0)); }

open3d::geometry::KDTreeSearchParamHybrid neighbourhood() { return {kRadius_m, kNeighbours}; }

void open3d_voxel_grid(benchmark::State& state) {
  const PointCloud cloud(known_scan(sensor_of(state)).raw.points);
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(cloud.VoxelDownSample(kVoxel_m));
  }
  count_each(state, cloud.points_.size(), {.bytes = kPointBytes});
}
BENCHMARK(open3d_voxel_grid)->Apply(all_sensors);

/// Builds its kd-tree too.
void open3d_normals(benchmark::State& state) {
  PointCloud cloud(known_scan(sensor_of(state)).thinned.points());
  for ([[maybe_unused]] auto _ : state) {
    cloud.EstimateNormals(neighbourhood());
    benchmark::ClobberMemory();
  }
  count_each(state, cloud.points_.size(), {.bytes = 2 * kPointBytes});
}
BENCHMARK(open3d_normals)->Apply(all_sensors);

/// Two scans with normals, from the start that preset paper has; includes the kd-tree of the target.
void open3d_icp(benchmark::State& state) {
  const KnownScan& last = known_scan(Sensor::kUsual, 0);
  PointCloud source(last.still.points());
  PointCloud target(known_scan(Sensor::kUsual, 1).thinned.points());
  source.EstimateNormals(neighbourhood());
  target.EstimateNormals(neighbourhood());
  Eigen::Matrix4d start = Eigen::Matrix4d::Identity();
  start.topRightCorner<3, 1>() = -0.1 * last.velocity_sensor;
  const icp::ICPConvergenceCriteria stop(1e-5, 1e-5, 100);
  const bool generalised = state.range(0) != 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(
        generalised
            ? icp::RegistrationGeneralizedICP(source, target, kVoxel_m, start,
                                              icp::TransformationEstimationForGeneralizedICP(), stop)
            : icp::RegistrationICP(source, target, kVoxel_m, start, icp::TransformationEstimationPointToPlane(), stop));
  }
  count_each(state, source.points_.size(), {.bytes = kPointBytes});
}
BENCHMARK(open3d_icp)
    ->ArgName("gicp")
    ->Arg(0)
    ->Arg(1)
    ->UseRealTime()
    ->MeasureProcessCPUTime()
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
