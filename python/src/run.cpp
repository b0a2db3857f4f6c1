// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <optional>

#include <pybind11/stl.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/map_writer.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"
#include "dynamic_icp/tools/report/run_report.hpp"
#include "dynamic_icp/tools/report/viewer_bundle.hpp"

#include "python/src/bindings.hpp"
#include "python/src/errors.hpp"
#include "python/src/frame_members.hpp"
#include "python/src/settings.hpp"

namespace dynamic_icp::python {
namespace {

namespace fs = std::filesystem;

template <class Value>
void take(const py::dict& options, const char* name, Value& value) {
  if (options.contains(name) && !options[name].is_none()) {
    value = options[name].cast<Value>();
  }
}

void take(const py::dict& options, const char* name, std::optional<fs::path>& path) {
  std::string text;
  take(options, name, text);
  path = text.empty() ? std::nullopt : std::optional<fs::path>(text);
}

runs::RunSettings run_settings_of(const py::dict& options) {
  runs::RunSettings settings;
  MethodTexts method;
  take(options, "method", method.method);
  take(options, "preset", method.preset);
  take(options, "ablation", method.ablation);
  take(options, "settings", method.settings);
  settings.config = config_of(method);
  settings.method = method.method;
  settings.preset = method.preset;
  settings.ablation = method.ablation;
  settings.output = options["output"].cast<std::string>();
  std::string ground_truth;
  take(options, "ground_truth", ground_truth);
  settings.ground_truth = ground_truth;
  take(options, "replace", settings.replace);
  take(options, "threads", settings.threads);
  take(options, "start", settings.start);
  std::optional<std::size_t> max_scans;
  take(options, "max_scans", max_scans);
  settings.max_frames = max_scans;
  take(options, "save_labels", settings.save_labels);
  take(options, "map_file", settings.map_file);
  take(options, "map_voxel", settings.map_voxel_m);
  take(options, "mcap_file", settings.mcap_file);
  take(options, "kitti_file", settings.kitti_file);
  take(options, "calibration", settings.calibration);
  take(options, "command", settings.command);
  return settings;
}

/// Calls back into Python from a run that has released the GIL. An interrupt, wherever it comes, is noted: it ends the
/// run after the scan at hand.
class Listener {
 public:
  template <class... Arguments>
  void call(const py::object& function, Arguments&&... arguments) {
    noting_interrupts([&] { function(std::forward<Arguments>(arguments)...); });
  }

  bool is_interrupted() {
    noting_interrupts([] { raise_interrupts(); });
    return interrupted_;
  }

 private:
  template <class Call>
  void noting_interrupts(const Call& call) {
    const py::gil_scoped_acquire gil;
    try {
      call();
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_KeyboardInterrupt)) {
        throw;
      }
      interrupted_ = true;
    }
  }

  bool interrupted_ = false;
};

py::dict run(const std::string& path, const Texts& input, const py::dict& options, const py::object& progress,
             const py::object& warning, const py::object& callback) {
  const runs::RunSettings settings = run_settings_of(options);
  const runs::Recording recording{path, input_settings_of(input)};
  Listener listener;
  runs::RunCallbacks callbacks;
  callbacks.fix_in_words = [&](const diagnosis::Finding& finding) { return fix_in_words(finding, recording.settings); };
  callbacks.warning = [&](const std::string& text) { listener.call(warning, text); };
  if (!progress.is_none()) {
    callbacks.progress = [&](std::size_t done, std::size_t total) { listener.call(progress, done, total); };
  }
  if (!callback.is_none()) {
    callbacks.frame = [&](std::size_t /*index*/, odometry::Frame frame) {
      const py::gil_scoped_acquire gil;
      listener.call(callback, frame_members(std::move(frame)));
    };
  }
  callbacks.stop = [&] { return listener.is_interrupted(); };
  const std::optional<runs::RunResult> result = [&] {
    const py::gil_scoped_release no_gil;
    return runs::run_recording(recording, settings, callbacks);
  }();
  py::dict members;
  members["interrupted"] = listener.is_interrupted();
  members["failures"] = result->failures;
  members["failure"] = result->summary.failure;
  return members;
}

void write_report(const std::string& folder, const std::string& html, int threads) {
  const py::gil_scoped_release no_gil;
  const std::optional<report::ViewerBundle> viewer = report::viewer_bundle();
  if (!viewer) {
    throw DataError(
        "this module was built without the viewer that draws the page: run scripts/install_viewer.sh in the folder of "
        "the sources, then build again");
  }
  formats::write_whole_file(html, report::html_page(report::run_report(folder, {}, Workers(threads)), *viewer));
}

/// What a map reads of a dynamic_icp.Frame.
odometry::Frame frame_for_map(const py::object& frame) {
  odometry::Frame read;
  read.stamp = Stamp{frame.attr("stamp_ns").cast<std::int64_t>()};
  read.T_world_sensor = pose_of(frame.attr("pose").cast<py::array>(), "pose");
  const VectorColumns points = vectors_of(frame.attr("static_points").cast<py::array>(), "static_points");
  for (std::size_t i = 0; i < points.size(); ++i) {
    read.static_points.push_back(points[i]);
  }
  for (const py::handle object : frame.attr("objects")) {
    const py::object box = object.attr("box");
    if (box.is_none()) {
      continue;
    }
    tracking::TrackedObject tracked;
    tracked.scans_seen = object.attr("scans_seen").cast<int>();
    tracked.tangential_observed = object.attr("tangential_observed").cast<bool>();
    tracked.velocity_sensor = vector_of(object.attr("velocity").cast<py::array>(), 3, "velocity");
    tracked.box.centre = vector_of(box.attr("center").cast<py::array>(), 3, "center");
    tracked.box.size = vector_of(box.attr("size").cast<py::array>(), 3, "size");
    const VectorColumns axes = vectors_of(box.attr("axes").cast<py::array>(), "axes");
    for (std::size_t row = 0; row < 3; ++row) {
      tracked.box.axes.row(static_cast<Eigen::Index>(row)) = axes[row].transpose();
    }
    read.tracked.push_back(tracked);
  }
  return read;
}

}  // namespace

void bind_run(py::module_& module) {
  module.def("run", &run, py::arg("path"), py::arg("input"), py::arg("options"), py::arg("progress"),
             py::arg("warning"), py::arg("callback"));
  module.def("write_report", &write_report, py::arg("folder"), py::arg("html"), py::arg("threads"));
  py::class_<runs::MapWriter>(module, "Map")
      .def(py::init<double>(), py::arg("voxel_size"))
      .def("__len__", &runs::MapWriter::size)
      .def(
          "add", [](runs::MapWriter& self, const py::object& frame) { self.add(frame_for_map(frame)); },
          py::arg("frame"))
      .def("points", [](const runs::MapWriter& self) { return moved(self.points()); })
      .def(
          "save", [](const runs::MapWriter& self, const std::string& path) { self.write(path); }, py::arg("path"));
}

}  // namespace dynamic_icp::python
