// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <memory>
#include <mutex>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include "python/src/bindings.hpp"
#include "python/src/scan_arrays.hpp"
#include "python/src/settings.hpp"
#include "python/src/trajectory_arrays.hpp"

namespace dynamic_icp::python {
namespace {

/// A recording that several threads may read from, one after the other.
class Recording {
 public:
  Recording(const std::string& path, const Texts& settings)
      : settings_(input_settings_of(settings)), dataset_(datasets::open_input(path, settings_)) {}

  [[nodiscard]] const datasets::Dataset& dataset() const { return *dataset_; }

  [[nodiscard]] py::dict scan(std::size_t index) {
    check(index);
    return scan_members([&] {
      const py::gil_scoped_release no_gil;
      const std::lock_guard lock(reading_);
      return dataset_->scan(index);
    }());
  }

  [[nodiscard]] std::string scan_file(std::size_t index) const {
    check(index);
    return dataset_->scan_file(index).string();
  }

  [[nodiscard]] py::array_t<std::int64_t> stamps_ns() const {
    std::vector<std::int64_t> stamps;
    for (const Stamp stamp : datasets::stamps_of(*dataset_)) {
      stamps.push_back(stamp.ns);
    }
    return moved(std::move(stamps));
  }

  [[nodiscard]] py::list diagnose(std::size_t probes, int threads);

 private:
  void check(std::size_t index) const {
    if (index >= dataset_->size()) {
      throw py::index_error(fmt::format("scan {} of a recording of {} scans", index, dataset_->size()));
    }
  }

  datasets::InputSettings settings_;
  std::unique_ptr<datasets::Dataset> dataset_;
  std::mutex reading_;
};

py::dict finding_members(const diagnosis::Finding& finding, const datasets::InputSettings& settings) {
  py::dict evidence;
  for (const auto& [name, number] : finding.evidence) {
    evidence[py::str(name)] = number;
  }
  py::dict members;
  members["question"] = std::string(to_string(finding.question));
  members["verdict"] = std::string(to_string(finding.verdict));
  members["sentence"] = finding.sentence;
  members["fix"] = fix_in_words(finding, settings);
  members["evidence"] = evidence;
  return members;
}

py::list Recording::diagnose(std::size_t probes, int threads) {
  diagnosis::DiagnosisConfig config;
  config.probes = probes;
  config.applied = settings_.correction;
  const diagnosis::Diagnosis result = [&] {
    const py::gil_scoped_release no_gil;
    const std::lock_guard lock(reading_);
    return diagnosis::diagnose(*dataset_, config, Workers(threads));
  }();
  py::list findings;
  for (const diagnosis::Finding& finding : result.findings) {
    findings.append(finding_members(finding, settings_));
  }
  return findings;
}

}  // namespace

void bind_recording(py::module_& module) {
  py::class_<Recording>(module, "Recording")
      .def(py::init<const std::string&, const Texts&>(), py::arg("path"), py::arg("settings"),
           py::call_guard<py::gil_scoped_release>())
      .def("__len__", [](const Recording& self) { return self.dataset().size(); })
      .def("scan", &Recording::scan, py::arg("index"))
      .def("scan_file", &Recording::scan_file, py::arg("index"))
      .def("stamps_ns", &Recording::stamps_ns)
      .def("format", [](const Recording& self) { return std::string(self.dataset().format()); })
      .def("assumptions", [](const Recording& self) { return self.dataset().assumptions(); })
      .def("doppler_kind", [](const Recording& self) { return word_of(self.dataset().doppler_kind()); })
      .def("ground_truth", [](const Recording& self) { return trajectory_arrays(self.dataset().ground_truth()); })
      .def("T_vehicle_sensor", [](const Recording& self) { return copied_or_none(self.dataset().T_vehicle_sensor()); })
      .def("diagnose", &Recording::diagnose, py::arg("probes"), py::arg("threads"));
  module.def("known_formats", &datasets::known_formats);
}

}  // namespace dynamic_icp::python
