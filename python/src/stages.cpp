// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/method/dynamics/condensed_tree.hpp"
#include "dynamic_icp/method/dynamics/hdbscan.hpp"
#include "dynamic_icp/method/ego_motion/consensus_regression.hpp"
#include "dynamic_icp/method/ego_motion/doppler_regression.hpp"
#include "dynamic_icp/method/ego_motion/velocity_filter.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"
#include "dynamic_icp/method/preprocess/normals.hpp"

#include "python/src/bindings.hpp"
#include "python/src/frame_members.hpp"
#include "python/src/scan_arrays.hpp"
#include "python/src/settings.hpp"

namespace dynamic_icp::python {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<Eigen::Vector3d> all_of(const VectorColumns& columns) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    points.push_back(columns[i]);
  }
  return points;
}

template <class Config>
Config configured(const Texts& settings) {
  Config config;
  const ConfigFields list = fields(config);
  for (const auto& [key, value] : settings) {
    set_field(list, key, value);
  }
  return config;
}

py::dict ego_velocity(const py::object& py_scan, const std::string& method, const py::object& prior,
                      const Texts& settings, int threads) {
  const ScanArrays arrays(py_scan);
  const std::optional<Eigen::Vector3d> velocity =
      prior.is_none() ? std::nullopt : std::optional<Eigen::Vector3d>(vector_of(prior.cast<py::array>(), 3, "prior"));
  if (velocity && !velocity->allFinite()) {
    throw UsageError("prior has numbers that are not finite");
  }
  if (method != "consensus" && method != "huber") {
    throw UsageError(fmt::format("method is '{}', expected consensus or huber", method));
  }
  const auto estimate = [&] {
    const Workers workers(threads);
    const Scan scan = Scan::from_raw(arrays.view(), {}, workers);
    if (method == "huber") {
      return ego_motion::estimate_velocity(scan, velocity.value_or(Eigen::Vector3d::Zero()),
                                           configured<ego_motion::DopplerRegressionConfig>(settings), workers);
    }
    ego_motion::EgoPrior known;
    known.has_velocity = velocity.has_value();
    known.mean.head<3>() = velocity.value_or(Eigen::Vector3d::Zero());
    return ego_motion::estimate_velocity(scan, known, configured<ego_motion::ConsensusRegressionConfig>(settings),
                                         workers);
  };
  const ego_motion::EgoVelocity ego = [&] {
    const py::gil_scoped_release no_gil;
    return estimate();
  }();
  return ego_members(ego);
}

/// Which points move, and their Doppler without the sensor's motion: of each point as given, also of those that are no
/// measurements.
py::tuple velocity_filter(const py::object& py_scan, const py::array& py_velocity, double tau_0, double kappa) {
  const ScanArrays arrays(py_scan);
  const Eigen::Vector3d velocity = vector_of(py_velocity, 3, "velocity");
  ego_motion::VelocityFilterConfig config{.enabled = true, .tau_0_mps = tau_0, .kappa_per_s = kappa};
  check_fields(fields(config));
  const std::size_t n = arrays.view().points.size();
  std::vector<std::uint8_t> moving(n, 0);
  std::vector<double> of_points(n, kNaN);
  {
    const py::gil_scoped_release no_gil;
    const Scan scan = Scan::from_raw(arrays.view());
    const std::vector<double> compensated = ego_motion::compensated_doppler(scan, velocity);
    const std::vector<std::uint8_t> mask = ego_motion::dynamic_mask(scan, compensated, config);
    for (std::size_t row = 0; row < scan.size(); ++row) {
      moving[scan.records()[row]] = mask[row];
      of_points[scan.records()[row]] = compensated[row];
    }
  }
  return py::make_tuple(moved(std::move(moving)), moved(std::move(of_points)));
}

py::dict tree_members(const dynamics::CondensedTree& tree) {
  std::vector<std::uint32_t> parent;
  std::vector<std::uint32_t> size;
  std::vector<double> birth;
  std::vector<double> death;
  std::vector<double> stability;
  for (const dynamics::CondensedTree::Cluster& cluster : tree.clusters) {
    parent.push_back(cluster.parent);
    size.push_back(cluster.size);
    birth.push_back(cluster.birth);
    death.push_back(cluster.death);
    stability.push_back(cluster.stability);
  }
  py::dict members;
  members["parent"] = moved(std::move(parent));
  members["size"] = moved(std::move(size));
  members["birth"] = moved(std::move(birth));
  members["death"] = moved(std::move(death));
  members["stability"] = moved(std::move(stability));
  members["point_cluster"] = moved(tree.point_cluster);
  members["point_lambda"] = moved(tree.point_lambda);
  return members;
}

py::dict hdbscan(const py::array& py_points, int min_cluster_size, int min_samples, bool allow_single_cluster,
                 int threads) {
  std::vector<Eigen::Vector3d> points = all_of(vectors_of(py_points, "points"));
  const dynamics::HdbscanConfig config{min_cluster_size, min_samples, allow_single_cluster};
  dynamics::CondensedTree tree;
  dynamics::HdbscanResult result = [&] {
    const py::gil_scoped_release no_gil;
    return dynamics::hdbscan(points, config, Workers(threads), &tree);
  }();
  py::dict members;
  members["labels"] = moved(std::move(result.labels));
  members["probabilities"] = moved(std::move(result.probabilities));
  members["stabilities"] = moved(std::move(result.stabilities));
  members["tree"] = tree_members(tree);
  return members;
}

/// NaN where there is no plane, and for points that are not finite.
py::array_t<double> normals(const py::array& py_points, double radius, int max_neighbours, int threads) {
  const VectorColumns columns = vectors_of(py_points, "points");
  preprocess::NormalsConfig config{radius, max_neighbours};
  check_fields(fields(config));
  std::vector<Eigen::Vector3d> of_points(columns.size(), Eigen::Vector3d::Constant(kNaN));
  {
    const py::gil_scoped_release no_gil;
    std::vector<Eigen::Vector3d> points;
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const Eigen::Vector3d point = columns[i];
      if (point.allFinite()) {
        points.push_back(point);
        rows.push_back(i);
      }
    }
    const Workers workers(threads);
    const preprocess::Normals found =
        preprocess::estimate_normals(points, spatial::KdTree(points, workers), config, workers);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (found.has(i)) {
        of_points[rows[i]] = found.vectors[i];
      }
    }
  }
  return moved(std::move(of_points));
}

py::array_t<double> deskew(const py::array& py_points, const py::array& py_times, const py::array& py_twist) {
  const VectorColumns points = vectors_of(py_points, "points");
  const Column times = column_of(py_times, "times");
  const Vector6d twist = vector_of(py_twist, 6, "twist");
  if (times.size() != points.size()) {
    throw UsageError(
        fmt::format("times has {} entries, expected one for each of {} points", times.size(), points.size()));
  }
  if (!twist.allFinite()) {
    throw UsageError("twist has numbers that are not finite");
  }
  std::vector<Eigen::Vector3d> deskewed;
  {
    const py::gil_scoped_release no_gil;
    deskewed = all_of(points);
    motion::TimeSpan span;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!(std::abs(times[i]) <= kMaxPointTime_s)) {
        throw UsageError(fmt::format("times[{}] is {} s, expected at most {} s before or after the stamp", i, times[i],
                                     kMaxPointTime_s));
      }
      span = i == 0 ? motion::TimeSpan{times[0], times[0]}
                    : motion::TimeSpan{std::min(span.first, times[i]), std::max(span.last, times[i])};
    }
    const motion::Deskewer deskewer(motion::constant_sweep(twist), span);
    for (std::size_t i = 0; i < deskewed.size(); ++i) {
      deskewed[i] = deskewer.at_stamp(deskewed[i], times[i]);
    }
  }
  return moved(std::move(deskewed));
}

}  // namespace

void bind_stages(py::module_& module) {
  module.def("ego_velocity", &ego_velocity, py::arg("scan"), py::arg("method"), py::arg("prior"), py::arg("settings"),
             py::arg("threads"));
  module.def("velocity_filter", &velocity_filter, py::arg("scan"), py::arg("velocity"), py::arg("tau_0"),
             py::arg("kappa"));
  module.def("hdbscan", &hdbscan, py::arg("points"), py::arg("min_cluster_size"), py::arg("min_samples"),
             py::arg("allow_single_cluster"), py::arg("threads"));
  module.def("normals", &normals, py::arg("points"), py::arg("radius"), py::arg("max_neighbours"), py::arg("threads"));
  module.def("deskew", &deskew, py::arg("points"), py::arg("times"), py::arg("twist"));
}

}  // namespace dynamic_icp::python
