// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"

#include "fuzz/memory_file.hpp"
#include "testing/adversarial_scans.hpp"
#include "testing/crafted_state.hpp"
#include "testing/synthetic_street.hpp"

namespace {

using namespace dynamic_icp;

constexpr int kScans = 6;
constexpr int kScansAfter = 2;
constexpr std::size_t kEditBytes = 16;

RawScan scan(int k) {
  using namespace odometry::synthetic;
  Sensor sensor;
  sensor.sweep_s = 0.1;
  sensor.columns = 80;
  sensor.rows = 16;
  return scan_at(street_with_cars(), agile(10.0), sensor, 0.1 * k, 0).raw;
}

/// What each pipeline knows after each scan.
const std::string& saved(std::size_t pipeline, std::size_t after) {
  static std::map<std::size_t, std::vector<std::string>> states;
  std::vector<std::string>& known = states[pipeline];
  if (known.empty()) {
    const auto odometry = odometry::make_odometry(odometry::pipelines()[pipeline].config, {}, 1);
    for (int k = 0; k < kScans; ++k) {
      odometry->process(scan(k));
      known.push_back(odometry->save());
    }
  }
  return known[after];
}

}  // namespace

// A saved state with changed bytes and a checksum that fits is refused, or what goes on from it ends by itself: the
// numbers may be wrong. The first bytes choose the pipeline and after which scan it was saved, each further 16 change
// it in one place.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2 + kEditBytes) {
    return 0;
  }
  const std::size_t pipeline = data[0] % odometry::pipelines().size();
  const std::size_t after = data[1] % kScans;
  std::string state = saved(pipeline, after);
  crafted::remove_checksum(state);
  for (std::size_t at = 2; at + kEditBytes <= size; at += kEditBytes) {
    std::uint64_t numbers[2] = {};
    std::memcpy(numbers, data + at, sizeof numbers);
    crafted::StateEdit(numbers[0], numbers[1]).apply(state);
  }
  StateArchive::seal(state);
  const auto odometry = odometry::make_odometry(odometry::pipelines()[pipeline].config, {}, 1);
  try {
    odometry->load(state);
  } catch (const DataError&) {
    return 0;
  }
  try {
    for (int k = 0; k < kScansAfter; ++k) {
      odometry->process(scan(static_cast<int>(after) + 1 + k));
    }
  } catch (const DataError&) {
    return 0;
  }
  return 0;
}
