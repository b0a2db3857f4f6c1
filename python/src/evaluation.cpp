// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/evaluation/evaluation.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"
#include "dynamic_icp/recording/evaluation/evaluation_report.hpp"
#include "dynamic_icp/recording/formats/kitti_write.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

#include "python/src/bindings.hpp"
#include "python/src/trajectory_arrays.hpp"

namespace dynamic_icp::python {
namespace {

constexpr std::array kAlignments = {evaluation::Alignment::kNone, evaluation::Alignment::kFirst,
                                    evaluation::Alignment::kSe3, evaluation::Alignment::kSim3};
constexpr std::array<const char*, 3> kGapUnits = {"frames", "seconds", "meters"};

evaluation::EvaluationConfig config_of(const std::string& align, const std::string& gap_unit, double gap_length,
                                       double max_gap) {
  evaluation::EvaluationConfig config;
  const auto alignment = std::ranges::find(kAlignments, align, evaluation::alignment_name);
  if (alignment == kAlignments.end()) {
    throw UsageError(fmt::format("align is '{}', expected none, first, se3 or sim3", align));
  }
  const auto unit = std::ranges::find(kGapUnits, gap_unit, [](const char* name) { return std::string(name); });
  if (unit == kGapUnits.end()) {
    throw UsageError(fmt::format("gap_unit is '{}', expected frames, seconds or meters", gap_unit));
  }
  config.alignment = *alignment;
  config.gap = {static_cast<evaluation::GapUnit>(unit - kGapUnits.begin()), gap_length};
  config.association.max_gap_s = max_gap;
  return config;
}

py::dict evaluate(const py::array& estimate_stamps, const py::array& estimate_poses, const py::array& reference_stamps,
                  const py::array& reference_poses, const std::string& align, const std::string& gap_unit,
                  double gap_length, double max_gap) {
  const evaluation::EvaluationConfig config = config_of(align, gap_unit, gap_length, max_gap);
  const formats::Trajectory estimate = trajectory_of(estimate_stamps, estimate_poses, "estimate");
  const formats::Trajectory reference = trajectory_of(reference_stamps, reference_poses, "reference");
  const evaluation::Evaluation result = [&] {
    const py::gil_scoped_release no_gil;
    return evaluation::evaluate(estimate, reference, config);
  }();
  const evaluation::EvaluationSource source = {.estimate = "estimate", .reference = "reference"};
  std::vector<double> translation;
  std::vector<double> rotation;
  for (const evaluation::RelativeStep& step : result.relative.steps) {
    translation.push_back(step.error.translation_m);
    rotation.push_back(step.error.rotation_deg);
  }
  py::dict members;
  members["json"] = evaluation::evaluation_json(result, source);
  members["table"] = evaluation::evaluation_table(result, source);
  members["rte_m"] = moved(std::move(translation));
  members["rre_deg"] = moved(std::move(rotation));
  members["ate_m"] = moved(result.absolute.errors_m);
  members["T_reference_estimate"] = copied(result.absolute.T_reference_estimate);
  return members;
}

/// Stamps, poses and whether the file has stamps at all.
py::tuple read_trajectory(const std::string& path) {
  const datasets::PoseFile file = datasets::read_pose_file(path);
  const py::tuple arrays = trajectory_arrays(file.poses);
  return py::make_tuple(arrays[0], arrays[1], file.has_stamps);
}

void write_trajectory(const std::string& path, const py::array& stamps, const py::array& poses,
                      const std::string& format) {
  const formats::Trajectory trajectory = trajectory_of(stamps, poses, "trajectory");
  if (format == "tum") {
    formats::write_tum(path, trajectory);
  } else if (format == "kitti") {
    formats::write_kitti(path, trajectory);
  } else {
    throw UsageError(fmt::format("format is '{}', expected tum or kitti", format));
  }
}

}  // namespace

void bind_evaluation(py::module_& module) {
  module.def("evaluate", &evaluate, py::arg("estimate_stamps"), py::arg("estimate_poses"), py::arg("reference_stamps"),
             py::arg("reference_poses"), py::arg("align"), py::arg("gap_unit"), py::arg("gap_length"),
             py::arg("max_gap"));
  module.def("read_trajectory", &read_trajectory, py::arg("path"));
  module.def("write_trajectory", &write_trajectory, py::arg("path"), py::arg("stamps"), py::arg("poses"),
             py::arg("format"));
}

}  // namespace dynamic_icp::python
