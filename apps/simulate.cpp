// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/base/config_field.hpp"
#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/base/parallel.hpp"
#include "dynamic_icp/base/version.hpp"
#include "dynamic_icp/formats/output_folder.hpp"
#include "dynamic_icp/simulation/scene.hpp"
#include "dynamic_icp/simulation/sequence_writer.hpp"
#include "dynamic_icp/simulation/simulation.hpp"

#include "apps/commands.hpp"
#include "apps/progress.hpp"
#include "apps/settings.hpp"

namespace dynamic_icp::apps {
namespace {

using simulation::SceneKind;
using simulation::SequenceCounts;
using simulation::Simulation;
using simulation::SimulationConfig;

struct SimulateOptions {
  std::string scene;
  std::string output;
  std::string frames;
  std::string seed;
  std::vector<std::string> settings;
  int threads = 0;
  bool list = false;
  bool noise_free = false;
  bool force = false;
  bool quiet = false;
};

int list_scenes() {
  for (const SceneKind& kind : simulation::scene_kinds()) {
    fmt::print("{:<14} {} ({:g} m/s)\n", kind.name, kind.description, kind.speed_mps);
  }
  return 0;
}

/// The keys of --set with their defaults, for the help.
std::string settings_help() {
  SimulationConfig config;
  std::string text = "Settings for --set key=value (speed_mps: the default depends on the scene, see --list):\n";
  for (const ConfigField& field : simulation::fields(config)) {
    const std::string unit = field.unit.empty() ? "" : " " + field.unit;
    text += fmt::format("  {:<30} {} [{}{}; {}]\n", field.key, field.description, value_text(field), unit,
                        range_text(field));
  }
  return text;
}

SimulationConfig make_config(const SceneKind& kind, const SimulateOptions& options) {
  SimulationConfig config = simulation::default_config(kind);
  const ConfigFields fields = simulation::fields(config);
  apply_settings(fields, options.settings);
  if (!options.frames.empty()) {
    set_field(fields, "frames", options.frames);
  }
  if (!options.seed.empty()) {
    set_field(fields, "seed", options.seed);
  }
  if (options.noise_free) {
    config.lidar = simulation::without_noise(config.lidar);
  }
  return config;
}

void print_summary(const Simulation& simulation, const SequenceCounts& counts, double seconds,
                   const std::string& output) {
  const auto per_scan = [&](std::size_t n) { return static_cast<double>(n) / static_cast<double>(counts.scans); };
  const double moving_percent =
      counts.points == 0 ? 0.0 : 100.0 * static_cast<double>(counts.moving_points) / static_cast<double>(counts.points);
  fmt::print("scene          {}, seed {}\n", simulation.kind().name, simulation.config().seed);
  fmt::print("scans          {} at {:g} Hz, {:.0f} m driven\n", counts.scans, simulation.config().lidar.rate_hz,
             counts.path_length_m);
  fmt::print("points         {:.0f} per scan, {:.1f} % on moving bodies\n", per_scan(counts.points), moving_percent);
  fmt::print("moving bodies  {:.1f} seen per scan\n", per_scan(counts.objects));
  fmt::print("time           {:.1f} s, {:.1f} scans/s\n", seconds, static_cast<double>(counts.scans) / seconds);
  fmt::print("written to     {}\n", output);
}

int simulate(const SimulateOptions& options) {
  if (options.list) {
    return list_scenes();
  }
  if (options.scene.empty()) {
    throw UsageError("simulate: name a scene (--list shows them)");
  }
  const SceneKind& kind = simulation::find_scene(options.scene);
  const SimulationConfig config = make_config(kind, options);
  if (options.output.empty()) {
    throw UsageError("simulate: --output DIR is missing");
  }
  const auto started = std::chrono::steady_clock::now();
  const Workers workers(options.threads);
  formats::OutputFolder output(options.output, "scene.json", options.force);
  const Simulation simulation(kind, config);
  simulation::SequenceWriter writer(output.path());
  {
    Progress progress(fmt::format("simulating {}", kind.name), simulation.size(), options.quiet);
    for (std::size_t i = 0; i < simulation.size(); ++i) {
      writer.add(simulation.frame(i, workers));
      progress.advance();
    }
  }
  writer.finish(simulation, version());
  output.commit();
  if (!options.quiet) {
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
    print_summary(simulation, writer.counts(), elapsed.count(), options.output);
  }
  return 0;
}

}  // namespace

void add_simulate_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<SimulateOptions>();
  const SimulationConfig defaults;
  CLI::App* command = app.add_subcommand("simulate", "Make an FMCW LiDAR sequence with full ground truth");
  command->add_option("scene", options->scene, "Which scene (--list shows them)")->type_name("SCENE");
  command->add_flag("--list", options->list, "List the scenes and end");
  command->add_option("--output", options->output, "Folder to write; must be new or empty")->type_name("DIR");
  command->add_option("--frames", options->frames, fmt::format("Number of scans (default {})", defaults.frames))
      ->type_name("N");
  command
      ->add_option("--seed", options->seed,
                   fmt::format("Decides on layout, traffic and noise (default {})", defaults.seed))
      ->type_name("N");
  command->add_option("--threads", options->threads, "Threads, 0 for all (default 0); the result does not depend on it")
      ->type_name("N")
      ->check(CLI::Range(0, 1024));
  command->add_option("--set", options->settings, "Change a setting, see below; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command->add_flag("--noise-free", options->noise_free,
                    "No noise, bias, quantisation, outliers or dropouts (wins over --set)");
  command->add_flag("--force", options->force, "Replace an earlier simulated sequence in the output folder");
  command->add_flag("--quiet", options->quiet, "Print nothing but errors");
  command->footer(settings_help);
  command->callback([options, &selected] { selected = [options] { return simulate(*options); }; });
}

}  // namespace dynamic_icp::apps
