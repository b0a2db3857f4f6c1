// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/recording/formats/config_file.hpp"
#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/tools/benchmark/manifest.hpp"
#include "dynamic_icp/tools/scenes/scene_file.hpp"
#include "dynamic_icp/tools/simulation/rig.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

/// Settings and their names, which take longer to make than to read: made once.
struct Settings {
  explicit Settings(const odometry::Pipeline& pipeline)
      : first(pipeline.config), config(first), names(fields(config)) {}

  odometry::Config first;
  odometry::Config config;
  ConfigFields names;  // point into `config`
};

std::vector<std::unique_ptr<Settings>> settings_of_pipelines() {
  std::vector<std::unique_ptr<Settings>> all;
  for (const odometry::Pipeline& pipeline : odometry::pipelines()) {
    all.push_back(std::make_unique<Settings>(pipeline));
  }
  return all;
}

/// Settings that are read say, when they are written, what is read again as the same.
void read_settings(const std::filesystem::path& path, Settings& settings) {
  settings.config = settings.first;
  formats::load_config_file(path, settings.names);
  const std::string text = formats::config_yaml(settings.names);
  const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  settings.config = settings.first;
  formats::load_config_file(written.path(), settings.names);
  fuzz::must(formats::config_yaml(settings.names) == text);
}

/// Two folders to find by their names: a recording, and one that holds nothing.
struct Recordings {
  fuzz::EmptyFolder empty;
  std::filesystem::path folder = empty.path() / "root";

  Recordings() {
    std::filesystem::create_directories(folder / "Bridge" / "01_Day" / "point_clouds");
    std::filesystem::create_directories(folder / "nothing");
    for (const char* name : {"1.bin", "2.bin"}) {
      std::ofstream(folder / "Bridge" / "01_Day" / "point_clouds" / name) << std::string(16, '\0');
    }
  }
};

void read_manifest(const std::filesystem::path& path) {
  static const Recordings recordings;
  const benchmark::Manifest manifest = benchmark::read_manifest(path);
  datasets::InputSettings settings;
  benchmark::apply(manifest, settings);
  const benchmark::Sequences found = benchmark::open_manifest(manifest, recordings.folder, settings, {});
  fuzz::must(found.sequences.size() + found.skipped.size() == manifest.sequences.size());
}

void read_calibration(const fuzz::MemoryFile& file) {
  const auto calibration = runs::read_calibration_of(file.named("calibration.yaml").parent_path());
  const std::string text = runs::calibration_text(calibration.value());
  const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  fuzz::must(runs::calibration_text(runs::read_calibration(written.path())) == text);
}

}  // namespace

// YAML files that users write. The first byte says which: 0 a manifest, 1 what was learned of a sensor, 2 a scene, 3
// sensors to simulate, others the settings of a method. Any bytes are read or refused with a message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const fuzz::MemoryFile file(data + 1, size - 1);
  const std::size_t kind = data[0] - std::size_t{'0'};
  try {
    if (kind == 0) {
      read_manifest(file.path());
    } else if (kind == 1) {
      read_calibration(file);
    } else if (kind == 2) {
      static_cast<void>(scenes::load_scene_file(file.path()));
    } else if (kind == 3) {
      simulation::check(simulation::parse_rig({reinterpret_cast<const char*>(data) + 1, size - 1}, "rig.yaml"));
    } else {
      static const std::vector<std::unique_ptr<Settings>> settings = settings_of_pipelines();
      read_settings(file.path(), *settings[kind % settings.size()]);
    }
  } catch (const DataError&) {
  } catch (const UsageError&) {
  }
  return 0;
}
