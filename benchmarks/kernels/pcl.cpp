// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// The Point Cloud Library beside our own steps, on the same scans; one thread.
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>
#include <pcl/search/kdtree.h>

#include "benchmarks/kernels/counters.hpp"
#include "benchmarks/kernels/scans.hpp"

namespace dynamic_icp::kernels {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

constexpr float kVoxel_m = 0.3F;
constexpr int kNeighbours = 30;
constexpr std::size_t kFloatPointBytes = 16;

Sensor sensor_of(const benchmark::State& state) { return static_cast<Sensor>(state.range(0)); }

Cloud::Ptr cloud_of(const std::vector<Eigen::Vector3d>& points) {
  Cloud::Ptr cloud(new Cloud);
  cloud->reserve(points.size());
  for (const Eigen::Vector3d& point : points) {
    pcl::PointNormal row;
    row.getVector3fMap() = point.cast<float>();
    cloud->push_back(row);
  }
  return cloud;
}

void add_normals(const Cloud::Ptr& cloud) {
  pcl::NormalEstimation<pcl::PointNormal, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>));
  estimation.setKSearch(kNeighbours);
  Cloud normals;
  estimation.compute(normals);
  for (std::size_t i = 0; i < cloud->size(); ++i) {
    (*cloud)[i].getNormalVector3fMap() = normals[i].getNormalVector3fMap();
  }
}

void pcl_voxel_grid(benchmark::State& state) {
  const Cloud::Ptr cloud = cloud_of(known_scan(sensor_of(state)).raw.points);
  pcl::VoxelGrid<pcl::PointNormal> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(kVoxel_m, kVoxel_m, kVoxel_m);
  grid.setDownsampleAllData(false);
  Cloud thinned;
  for ([[maybe_unused]] auto _ : state) {
    grid.filter(thinned);
    benchmark::DoNotOptimize(thinned);
  }
  count_each(state, cloud->size(), {.bytes = kFloatPointBytes});
}
BENCHMARK(pcl_voxel_grid)->Apply(all_sensors);

/// Builds its kd-tree too.
void pcl_normals(benchmark::State& state) {
  const Cloud::Ptr cloud = cloud_of(known_scan(sensor_of(state)).thinned.points());
  for ([[maybe_unused]] auto _ : state) {
    add_normals(cloud);
    benchmark::ClobberMemory();
  }
  count_each(state, cloud->size(), {.bytes = 2 * kFloatPointBytes});
}
BENCHMARK(pcl_normals)->Apply(all_sensors);

/// Two scans with normals, from the start that preset paper has.
template <class Icp>
void pcl_align(benchmark::State& state) {
  const KnownScan& last = known_scan(Sensor::kUsual, 0);
  const Cloud::Ptr source = cloud_of(last.still.points());
  const Cloud::Ptr target = cloud_of(known_scan(Sensor::kUsual, 1).thinned.points());
  add_normals(source);
  add_normals(target);
  Eigen::Matrix4f start = Eigen::Matrix4f::Identity();
  start.topRightCorner<3, 1>() = (-0.1 * last.velocity_sensor).cast<float>();
  Icp icp;
  icp.setMaxCorrespondenceDistance(kVoxel_m);
  icp.setMaximumIterations(100);
  icp.setTransformationEpsilon(1e-8);
  icp.setEuclideanFitnessEpsilon(1e-5);
  icp.setInputSource(source);
  Cloud moved;
  for ([[maybe_unused]] auto _ : state) {
    icp.setInputTarget(target);  // builds the kd-tree again
    icp.align(moved, start);
    benchmark::DoNotOptimize(moved);
  }
  count_each(state, source->size(), {.bytes = kFloatPointBytes});
}

using PointToPlane = pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal>;
using Generalised = pcl::GeneralizedIterativeClosestPoint<pcl::PointNormal, pcl::PointNormal>;

void pcl_point_to_plane(benchmark::State& state) { pcl_align<PointToPlane>(state); }
BENCHMARK(pcl_point_to_plane)->UseRealTime()->Unit(benchmark::kMicrosecond);

void pcl_gicp(benchmark::State& state) { pcl_align<Generalised>(state); }
BENCHMARK(pcl_gicp)->UseRealTime()->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace dynamic_icp::kernels
