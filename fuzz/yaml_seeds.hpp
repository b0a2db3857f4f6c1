// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/odometry/config.hpp"
#include "dynamic_icp/method/window/window_config.hpp"
#include "dynamic_icp/recording/formats/config_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/tools/simulation/rig.hpp"

namespace dynamic_icp::fuzz {

/// What a run may have learned of a sensor: two groups of errors.
inline window::SensorCalibration learned_errors() {
  window::SensorCalibration learned;
  learned.shape.views = {{-1.0, 2.0, -0.2, 0.3}};
  learned.shape.line_elevations_rad = {-0.1, 0.1};
  learned.parts = {{"offset", 0.1, {0.02}, {0.01}}, {"azimuth", 0.1, {0.03, -0.04}, {0.01, 0.02}}};
  learned.information = {{1e4}, {1.0, 1e4}, {0.0, 2.0, 1e3}};
  learned.gradient = {0.0, 0.5, -0.5};
  learned.stamp_sigma_s = 1e-4;
  learned.scan_error_mps = 1e-3;
  return learned;
}

/// Settings without the comments that describe them, most of the text of a file that is written.
inline std::string settings_text(const ConfigFields& fields) {
  std::string text;
  for (const ConfigField& field : fields) {
    text += fmt::format("{}: {}\n", field.key, value_text(field));
  }
  return text;
}

/// Files of each kind that settings.cpp reads, which their first byte names; right ones, and others.
inline std::vector<std::string> yaml_seeds() {
  std::vector<std::string> seeds = {
      "0description: two roads\nformat: hercules\nlidars: [front, 'rear']\nsequences:\n  - name: bridge-01\n"
      "    folders: [Bridge/01_Day, \"other\"]\n  - {name: b, folders: [c]}\n",
      "0description: one\nformat: auto\nsequences:\n  - {name: a, folders: [bridge/01-day]}\n"
      "  - {name: b, folders: [nothing]}\n  - {name: c, folders: [not there]}\n",
      "0description: none\nformat: dicp\nsequences: [{name: c, folders: [Nothing, not there]}]\n",
      "0description: twice\nformat: dicp\nsequences: [{name: a, folders: [b]}, {name: a, folders: [b]}]\n",
      "0description: elsewhere\nformat: dicp\nsequences: [{name: ../a, folders: [b]}]\n",
      "1" + runs::calibration_text({}),
      "1" + runs::calibration_text(learned_errors()),
      "2" + formats::read_text_file(DYNAMIC_ICP_EXAMPLE_SCENES "/crossing.yaml"),
      "2description: a wall\nspeed_mps: 10\nvehicle: {speed_mps: 10}\nstatics:\n  - box: {size_m: [1, 2, 3]}\n",
      "7preprocess:\n  voxel: {voxel_size_m: 0.5}\ntracking.coast_s: &a 1\n",
      "7{\"a\": {\"b\": [1, 2]}, \"c\": *a}",
      "7{\"poses\": [1, 2]}",
      "7[1, 2]",
      "7tracking.coast_s: 1\ntracking: {coast_s: &a 1, hits: *a}\npreprocess: {}\n",
      "7preprocess: {}\ntracking: &a 1\nregistration: *a\n",
      ""};
  for (const simulation::RigPreset& preset : simulation::rig_presets()) {
    seeds.push_back("3" + std::string(preset.yaml));
  }
  const std::vector<odometry::Pipeline>& pipelines = odometry::pipelines();
  for (std::size_t k = 0; k < pipelines.size(); ++k) {
    odometry::Config config = pipelines[k].config;
    seeds.push_back(static_cast<char>('0' + pipelines.size() * 2 + k) + settings_text(fields(config)));
  }
  return seeds;
}

/// A dictionary for libFuzzer: every key of these files with its colon, once, and what YAML is made of.
inline std::string yaml_dictionary(const std::vector<std::string>& seeds) {
  const auto is_of_key = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
  };
  std::set<std::string> words = {"- ",  "[",  "]",    "{",     "}",    ", ",   ": ",
                                 "&a ", "*a", "true", "false", ".nan", ".inf", "1e309"};
  for (const std::string& seed : seeds) {
    for (std::size_t colon = seed.find(':'); colon != std::string::npos; colon = seed.find(':', colon + 1)) {
      std::size_t begin = colon;
      while (begin > 0 && is_of_key(seed[begin - 1])) {
        --begin;
      }
      if (begin < colon) {
        words.insert(seed.substr(begin, colon - begin) + ": ");
      }
    }
  }
  std::string text;
  for (const std::string& word : words) {
    text += fmt::format("\"{}\"\n", word);
  }
  return text;
}

}  // namespace dynamic_icp::fuzz
