// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/odometry/odometry.hpp"

#include <memory>
#include <mutex>
#include <optional>

#include <pybind11/stl.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/calibration_file.hpp"

#include "python/src/bindings.hpp"
#include "python/src/frame_members.hpp"
#include "python/src/scan_arrays.hpp"
#include "python/src/settings.hpp"

namespace dynamic_icp::python {
namespace {

/// An odometry for one thread at a time: which scan is the next one must not be a matter of chance.
class OneOdometry {
 public:
  OneOdometry(const MethodTexts& method, int threads, const odometry::SensorContext& context)
      : config_(config_of(method)), odometry_(odometry::make_odometry(config_, context, threads)) {}

  py::dict process(const py::object& scan) {
    const ScanArrays arrays(scan);
    odometry::Frame frame = [&] {
      const py::gil_scoped_release no_gil;
      const std::unique_lock lock(busy_, std::try_to_lock);
      if (!lock.owns_lock()) {
        throw UsageError("another thread is processing a scan with this Odometry: each sequence needs one of its own");
      }
      return odometry_->process(arrays.view());
    }();
    return frame_members(std::move(frame));
  }

  [[nodiscard]] py::dict settings() {
    py::dict values;
    for (const ConfigField& field : odometry::fields(config_)) {
      values[py::str(field.key)] = std::visit([](const auto* value) { return py::cast(*value); }, field.value);
    }
    return values;
  }

  [[nodiscard]] std::vector<std::string> assumptions() const { return odometry_->assumptions(); }

  /// Writes what was learned of the sensor.
  void save_calibration(const std::filesystem::path& path) const {
    const std::optional<window::SensorCalibration> learned = odometry_->calibration();
    if (!learned) {
      throw UsageError(
          "nothing was learned of the sensor: only preset 'default' of dynamic-icp learns, from its scans");
    }
    formats::write_whole_file(path, runs::calibration_text(*learned));
  }

 private:
  odometry::Config config_;
  std::unique_ptr<odometry::Odometry> odometry_;
  std::mutex busy_;
};

std::unique_ptr<OneOdometry> make(const std::string& method, const std::string& preset, const std::string& ablation,
                                  const Texts& settings, int threads, const py::object& T_vehicle_sensor,
                                  const std::string& doppler_kind, const std::optional<std::string>& calibration) {
  odometry::SensorContext context;
  if (!T_vehicle_sensor.is_none()) {
    context.T_vehicle_sensor = pose_of(T_vehicle_sensor.cast<py::array>(), "T_vehicle_sensor");
  }
  context.doppler_kind = doppler_kind_of(doppler_kind);
  if (calibration) {
    context.calibration = runs::read_calibration(*calibration);
  }
  return std::make_unique<OneOdometry>(MethodTexts{method, preset, ablation, settings}, threads, context);
}

/// The keys of a pipeline, each with default, range, unit and meaning.
py::list configuration_keys(const std::string& method, const std::string& preset) {
  odometry::Config config = odometry::configuration(method, preset);
  py::list keys;
  for (const ConfigField& field : odometry::fields(config)) {
    keys.append(py::make_tuple(field.key, value_text(field), range_text(field), field.unit, field.description));
  }
  return keys;
}

}  // namespace

void bind_odometry(py::module_& module) {
  py::class_<OneOdometry>(module, "Odometry")
      .def(py::init(&make), py::arg("method"), py::arg("preset"), py::arg("ablation"), py::arg("settings"),
           py::arg("threads"), py::arg("T_vehicle_sensor"), py::arg("doppler_kind"), py::arg("calibration"))
      .def("process", &OneOdometry::process, py::arg("scan"))
      .def("settings", &OneOdometry::settings)
      .def("assumptions", &OneOdometry::assumptions)
      .def(
          "save_calibration", [](const OneOdometry& self, const std::string& path) { self.save_calibration(path); },
          py::arg("path"));
  module.def("configuration_keys", &configuration_keys, py::arg("method"), py::arg("preset"));
  module.def("method_names", &odometry::method_names);
  module.def("preset_names", &odometry::preset_names);
}

}  // namespace dynamic_icp::python
