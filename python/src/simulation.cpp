// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/simulation/simulation.hpp"

#include <filesystem>
#include <mutex>

#include <pybind11/stl.h>

#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/tools/scenes/scene_file.hpp"
#include "dynamic_icp/tools/simulation/sequence_folder.hpp"

#include "python/src/bindings.hpp"
#include "python/src/errors.hpp"
#include "python/src/scan_arrays.hpp"
#include "python/src/settings.hpp"
#include "python/src/trajectory_arrays.hpp"

namespace dynamic_icp::python {
namespace {

bool is_file(const std::string& name) { return name.ends_with(".yaml") || name.ends_with(".yml"); }

simulation::SimulationConfig config_of(const scenes::SceneKind& kind, const std::string& sensor, const Texts& settings,
                                       bool instant, bool noise_free) {
  simulation::SimulationConfig config = simulation::default_config(kind);
  config.rig = simulation::find_rig(sensor);
  for (const auto& [key, value] : settings) {
    simulation::set(config, key, value);
  }
  if (noise_free) {
    config.rig = simulation::without_noise(std::move(config.rig));
  }
  for (simulation::SensorConfig& one : config.rig.sensors) {
    one.lidar = instant ? simulation::instant(one.lidar) : one.lidar;
  }
  return config;
}

py::dict object_members(const simulation::ObjectTruth& object) {
  py::dict members;
  members["id"] = object.id;
  members["name"] = object.name;
  members["T_sensor_object"] = copied(object.T_sensor_body);
  members["center"] = copied(object.center_sensor);
  members["size"] = copied(object.size);
  members["velocity"] = copied(object.velocity_sensor);
  members["yaw_rate"] = object.yaw_rate_rps;
  members["points"] = object.points;
  return members;
}

/// A drive that can be asked for any of its scans.
class Drive {
 public:
  Drive(const std::string& scene, const std::string& sensor, const Texts& settings, bool instant, bool noise_free,
        int threads)
      : kind_(is_file(scene) ? scenes::load_scene_file(scene) : scenes::find_scene(scene)),
        simulation_(kind_, config_of(kind_, sensor, settings, instant, noise_free)),
        workers_(threads) {
    for (const std::string& name : {scene, sensor}) {
      if (is_file(name)) {
        inputs_.emplace_back(name);
      }
    }
  }

  [[nodiscard]] std::vector<std::string> sensors() const {
    std::vector<std::string> names;
    for (const simulation::SensorConfig& sensor : simulation_.config().rig.sensors) {
      names.push_back(sensor.name);
    }
    return names;
  }

  /// The scans of a sensor that were not lost.
  [[nodiscard]] std::vector<std::size_t> scans(std::size_t sensor) const {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < simulation_.size(); ++i) {
      if (!simulation_.scan_time(i, sensor).missing) {
        indices.push_back(i);
      }
    }
    return indices;
  }

  /// Stamps and poses of a sensor when those scans begin.
  [[nodiscard]] py::tuple ground_truth(std::size_t sensor) const {
    formats::Trajectory poses;
    for (const std::size_t i : scans(sensor)) {
      const simulation::ScanTime time = simulation_.scan_time(i, sensor);
      poses.push_back(
          {time.stamp, simulation_.sensor_state(seconds_between(Stamp{}, time.begin), sensor).T_world_sensor});
    }
    return trajectory_arrays(poses);
  }

  /// The scan with the truth about it; index and sensor must exist.
  [[nodiscard]] py::dict scan(std::size_t index, std::size_t sensor) const {
    simulation::SimulatedFrame frame = [&] {
      const py::gil_scoped_release no_gil;
      const std::lock_guard lock(busy_);
      return simulation_.frame(index, workers_, sensor);
    }();
    py::list objects;
    for (const simulation::ObjectTruth& object : frame.objects) {
      objects.append(object_members(object));
    }
    py::dict members;
    members["scan"] = scan_members(std::move(frame.scan.measured));
    members["pose"] = copied(frame.sensor.T_world_sensor);
    members["velocity"] = copied(frame.sensor.velocity_sensor);
    members["angular_velocity"] = copied(frame.sensor.angular_velocity_sensor);
    members["objects"] = objects;
    members["bodies"] = moved(std::move(frame.scan.bodies));
    members["true_range"] = moved(std::move(frame.scan.true_range));
    members["true_doppler"] = moved(std::move(frame.scan.true_doppler));
    return members;
  }

  /// Writes the sequence as the command `simulate` does.
  void write(const std::string& folder, const std::string& layout, bool point_truth, bool replace) const {
    const py::gil_scoped_release no_gil;
    const std::lock_guard lock(busy_);
    const simulation::SequenceOptions options{simulation::find_layout(layout), point_truth, false};
    formats::OutputFolder output(folder, simulation::sequence_result(), replace, inputs_);
    output.fill([&] {
      (void)simulation::write_sequence(simulation_, options, output.path(), workers_, [] { raise_interrupts(); });
    });
    output.commit();
  }

 private:
  scenes::SceneKind kind_;
  simulation::Simulation simulation_;
  Workers workers_;
  mutable std::mutex busy_;                    ///< the workers serve one thread at a time
  std::vector<std::filesystem::path> inputs_;  ///< files that were read and must not be replaced
};

py::list scene_names() {
  py::list names;
  for (const scenes::SceneKind& kind : scenes::scene_kinds()) {
    names.append(py::make_tuple(kind.name, kind.description, kind.speed_mps));
  }
  return names;
}

py::list sensor_names() {
  py::list names;
  for (const simulation::RigPreset& preset : simulation::rig_presets()) {
    names.append(std::string(preset.name));
  }
  return names;
}

}  // namespace

void bind_simulation(py::module_& module) {
  py::class_<Drive>(module, "Drive")
      .def(py::init<const std::string&, const std::string&, const Texts&, bool, bool, int>(), py::arg("scene"),
           py::arg("sensor"), py::arg("settings"), py::arg("instant"), py::arg("noise_free"), py::arg("threads"),
           py::call_guard<py::gil_scoped_release>())
      .def("sensors", &Drive::sensors)
      .def("scans", &Drive::scans, py::arg("sensor"))
      .def("ground_truth", &Drive::ground_truth, py::arg("sensor"))
      .def("scan", &Drive::scan, py::arg("index"), py::arg("sensor"))
      .def("write", &Drive::write, py::arg("folder"), py::arg("layout"), py::arg("point_truth"), py::arg("replace"));
  module.def("scene_names", &scene_names);
  module.def("sensor_names", &sensor_names);
}

}  // namespace dynamic_icp::python
