// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/config_field.hpp"
#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parallel.hpp"
#include "dynamic_icp/recording/formats/output_folder.hpp"
#include "dynamic_icp/tools/scenes/scene.hpp"
#include "dynamic_icp/tools/scenes/scene_file.hpp"
#include "dynamic_icp/tools/simulation/rig.hpp"
#include "dynamic_icp/tools/simulation/sequence_folder.hpp"
#include "dynamic_icp/tools/simulation/sequence_writer.hpp"
#include "dynamic_icp/tools/simulation/simulation.hpp"

#include "apps/commands.hpp"
#include "apps/messages.hpp"
#include "apps/options.hpp"
#include "apps/progress.hpp"
#include "apps/settings.hpp"

namespace dynamic_icp::apps {
namespace {

using scenes::SceneKind;
using simulation::SequenceCounts;
using simulation::Simulation;
using simulation::SimulationConfig;

struct SimulateOptions {
  std::string scene;
  std::string output;
  std::string sensor = std::string(simulation::kDefaultRig);
  std::string show_sensor;
  std::string layout = "dicp";
  std::string frames;
  std::string seed;
  std::vector<std::string> settings;
  int threads = 0;
  bool list = false;
  bool instant = false;
  bool noise_free = false;
  bool point_truth = false;
  bool calibration = false;
  bool force = false;
  bool quiet = false;
};

int list_choices() {
  fmt::print("Scenes (or a scene file, see docs/scenes.md):\n");
  for (const SceneKind& kind : scenes::scene_kinds()) {
    fmt::print("  {:<14} {} ({:g} m/s)\n", kind.name, kind.description, kind.speed_mps);
  }
  fmt::print("\nSensors (--sensor; or a sensor file: --show-sensor NAME prints one to begin with):\n");
  for (const simulation::RigPreset& preset : simulation::rig_presets()) {
    const simulation::Rig rig = simulation::find_rig(std::string(preset.name));
    fmt::print("  {:<14} {}\n", rig.name, rig.description);
  }
  return 0;
}

int show_sensor(const std::string& name) {
  for (const simulation::RigPreset& preset : simulation::rig_presets()) {
    if (preset.name == name) {
      fmt::print("{}", preset.yaml);
      return 0;
    }
  }
  (void)simulation::find_rig(name);  // tells the known names
  throw UsageError(fmt::format("--show-sensor '{}': is a file already", name));
}

std::string help_line(const ConfigField& field) {
  const std::string unit = field.unit.empty() ? "" : " " + field.unit;
  return fmt::format("  {:<40} {} [{}{}; {}]\n", field.key, field.description, value_text(field), unit,
                     range_text(field));
}

/// The keys of --set with their defaults, for the help.
std::string settings_help() {
  SimulationConfig config = simulation::default_config(scenes::scene_kinds().front());
  std::string text = "Settings for --set key=value (speed: the default depends on the scene, see --list):\n";
  for (const ConfigField& field : simulation::fields(config)) {
    text += help_line(field);
  }
  text +=
      "Of the sensor, here with the values of the default one; with several sensors of all of them, or of one as\n"
      "--set NAME.lidar.rows=32:\n";
  for (const ConfigField& field : fields(config.rig.sensors.front())) {
    text += help_line(field);
  }
  return text;
}

SimulationConfig make_config(const SceneKind& kind, const SimulateOptions& options) {
  SimulationConfig config = simulation::default_config(kind);
  config.rig = simulation::find_rig(options.sensor);
  for (const std::string& setting : options.settings) {
    const auto& [key, value] = split_setting(setting);
    simulation::set(config, key, value);
  }
  if (!options.frames.empty()) {
    simulation::set(config, "frames", options.frames);
  }
  if (!options.seed.empty()) {
    simulation::set(config, "seed", options.seed);
  }
  config.rig = options.noise_free ? simulation::without_noise(std::move(config.rig)) : config.rig;
  for (simulation::SensorConfig& sensor : config.rig.sensors) {
    sensor.lidar = options.instant ? simulation::instant(sensor.lidar) : sensor.lidar;
  }
  return config;
}

/// The scene that comes with the program or the one of a file.
SceneKind find_scene(const std::string& name) {
  return is_yaml_name(name) ? scenes::load_scene_file(name) : scenes::find_scene(name);
}

/// The files that the simulation reads.
std::vector<std::filesystem::path> inputs(const SimulateOptions& options) {
  std::vector<std::filesystem::path> files;
  for (const std::string& name : {options.scene, options.sensor}) {
    if (is_yaml_name(name)) {
      files.emplace_back(name);
    }
  }
  return files;
}

void print_summary(const Simulation& simulation, const SequenceCounts& counts, double seconds,
                   const SimulateOptions& options) {
  const SimulationConfig& config = simulation.config();
  const auto per_scan = [&](std::size_t n) { return static_cast<double>(n) / static_cast<double>(counts.scans); };
  const auto percent = [](std::size_t part, std::size_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
  };
  fmt::print("scene          {}, seed {}: {}\n", simulation.kind().name, config.scene.seed,
             simulation.kind().description);
  for (const simulation::SensorConfig& sensor : config.rig.sensors) {
    const simulation::FmcwLidarConfig& lidar = sensor.lidar;
    fmt::print("sensor         {}: {} x {} rays over {:g} x {:g} deg, {:g} Hz, {}\n", sensor.name, lidar.columns,
               lidar.rows, lidar.horizontal_fov_deg, lidar.vertical_fov_deg, lidar.rate_hz,
               lidar.sweep_s > 0.0 ? fmt::format("swept in {:g} s", lidar.sweep_s) : "instant");
  }
  fmt::print("drive          {} scans, {:.1f} s, {:.0f} m\n", config.frames,
             config.frames / config.rig.sensors.front().lidar.rate_hz, counts.path_length_m);
  fmt::print(
      "points         {:.0f} a scan, {:.1f} % of the rays; {:.1f} % on moving bodies, {:.2f} % mixed, {:.2f} % rain, "
      "{:.2f} % false\n",
      per_scan(counts.points), percent(counts.points, counts.rays), percent(counts.moving_points, counts.points),
      percent(counts.mixed_points, counts.points), percent(counts.rain_points, counts.points),
      percent(counts.false_points, counts.points));
  fmt::print("moving bodies  {} in the scene, {:.1f} seen a scan\n", simulation.scene().world.bodies.size(),
             per_scan(counts.objects));
  fmt::print("time           {:.1f} s, {:.1f} scans/s\n", seconds, static_cast<double>(counts.scans) / seconds);
  fmt::print("written to     {} (layout {}, picture overview.svg)\n", options.output, options.layout);
}

/// All files of the sequence, with its picture.
SequenceCounts write_sequence(const Simulation& simulation, const simulation::SequenceOptions& written,
                              const std::filesystem::path& folder, const SimulateOptions& options) {
  Progress progress(fmt::format("simulating {}", simulation.kind().name), simulation.size(), options.quiet);
  return simulation::write_sequence(simulation, written, folder, Workers(options.threads), [&] { progress.advance(); });
}

int simulate(const SimulateOptions& options) {
  if (options.list) {
    return list_choices();
  }
  if (!options.show_sensor.empty()) {
    return show_sensor(options.show_sensor);
  }
  if (options.scene.empty()) {
    throw UsageError("simulate: name a scene (--list shows them)");
  }
  const SceneKind kind = find_scene(options.scene);
  if (kind.former_name == options.scene && !options.quiet) {
    tell("dynamic-icp: note: scene '{}' is now '{}'; the former name goes with the next release\n", options.scene,
         kind.name);
  }
  const SimulationConfig config = make_config(kind, options);
  const simulation::SequenceOptions written{simulation::find_layout(options.layout), options.point_truth,
                                            options.calibration};
  if (options.output.empty()) {
    throw UsageError("simulate: --output DIR is missing");
  }
  const auto started = std::chrono::steady_clock::now();
  formats::OutputFolder output(options.output, simulation::sequence_result(), options.force, inputs(options));
  const Simulation simulation(kind, config);
  const SequenceCounts counts =
      output.fill([&] { return write_sequence(simulation, written, output.path(), options); });
  output.commit();
  if (!options.quiet) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
    print_summary(simulation, counts, elapsed.count(), options);
  }
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand("simulate", "Make an FMCW LiDAR sequence with full ground truth");
  add_option(*command, "scene", options->scene, "SCENE",
             "Name of a scene (--list shows them) or a scene file (*.yaml)");
  command->add_flag("--list", options->list, "List scenes and sensors and end");
  add_option(*command, "-o,--output", options->output, "DIR", "Folder to write; must be new or empty");
  add_option(
      *command, "--sensor", options->sensor, "NAME",
      fmt::format("Sensors of the vehicle, by name or as a file (*.yaml) (default {})", simulation::kDefaultRig));
  add_option(*command, "--show-sensor", options->show_sensor, "NAME", "Print the file of a sensor and end");
  add_option(
      *command, "--layout", options->layout, "NAME",
      "Files to write: dicp, hercules, helipr, boreas or aevascenes (default dicp); the truth is the same for all");
  add_option(*command, "--frames", options->frames, "N", "Number of scans, the length of the drive (default 60)");
  add_option(*command, "--seed", options->seed, "N", "Decides on layout, traffic and noise (default 1)");
  add_option(*command, "--threads", options->threads, "N",
             "Threads, 0 for all (default 0); the result does not depend on it")
      ->check(CLI::Range(0, 1024));
  add_option(*command, "--set", options->settings, "KEY=VALUE", "Change a setting, see below; may be repeated")
      ->allow_extra_args(false);
  command->add_flag("--instant", options->instant, "All rays of a scan at its stamp (wins over --set)");
  command->add_flag("--noise-free", options->noise_free,
                    "No error of measurement or time, rain, mixed, false or lost returns, vibration (wins over --set)");
  command->add_flag("--point-truth", options->point_truth, "Write true range and true Doppler of every point");
  command->add_flag("--calibration", options->calibration,
                    "Write calibration.json, and poses of the vehicle instead of the sensor (layout dicp)");
  command->add_flag("--force", options->force,
                    "Replace an earlier simulated sequence in DIR, which may hold nothing else");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->footer(settings_help);
  command->callback([options, &selected] { selected = [options] { return simulate(*options); }; });
}

}  // namespace dynamic_icp::apps
