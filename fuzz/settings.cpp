// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <string>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/recording/formats/config_file.hpp"
#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/tools/benchmark/manifest.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

/// Settings that are read say, when they are written, what is read again as the same.
void read_settings(const std::filesystem::path& path, const odometry::Pipeline& pipeline) {
  odometry::Config config = pipeline.config;
  formats::load_config_file(path, fields(config));
  const std::string text = formats::config_yaml(fields(config));
  const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  odometry::Config again = pipeline.config;
  formats::load_config_file(written.path(), fields(again));
  fuzz::must(formats::config_yaml(fields(again)) == text);
}

}  // namespace

// YAML files that users write. The first byte says which: 0 a manifest, 1 what was learned of a sensor, others the
// settings of a method. Any bytes are read or refused with a message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const fuzz::MemoryFile file(data + 1, size - 1);
  const std::size_t kind = data[0] - std::size_t{'0'};
  try {
    if (kind == 0) {
      benchmark::read_manifest(file.path());
    } else if (kind == 1) {
      const window::SensorCalibration calibration = runs::read_calibration(file.path());
      const std::string text = runs::calibration_text(calibration);
      const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
      fuzz::must(runs::calibration_text(runs::read_calibration(written.path())) == text);
    } else {
      const std::vector<odometry::Pipeline>& pipelines = odometry::pipelines();
      read_settings(file.path(), pipelines[kind % pipelines.size()]);
    }
  } catch (const DataError&) {
  } catch (const UsageError&) {
  }
  return 0;
}
