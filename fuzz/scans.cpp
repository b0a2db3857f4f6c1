// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/odometry/odometry.hpp"

#include "fuzz/memory_file.hpp"
#include "testing/adversarial_scans.hpp"

namespace {

constexpr int kScans = 8;

}  // namespace

// Scans of any numbers give frames of finite numbers, with every method. The first byte chooses the pipeline, the next
// one the seed of what the others leave open.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  if (size < 2) {
    return 0;
  }
  const std::vector<odometry::Pipeline>& pipelines = odometry::pipelines();
  const auto odometry = odometry::make_odometry(pipelines[data[0] % pipelines.size()].config, {}, 1);
  adversarial::ScanGenerator scans(data[1], {data + 2, size - 2});
  std::optional<Stamp> last;
  for (int k = 0; k < kScans; ++k) {
    const RawScan raw = scans.next();
    try {
      const odometry::Frame frame = odometry->process(raw);
      const std::optional<std::string> fault =
          adversarial::fault_of(frame, raw, last ? seconds_between(*last, raw.stamp) : 0.0);
      if (fault) {
        std::fprintf(stderr, "scan %d: %s\n", k, fault->c_str());
      }
      fuzz::must(!fault);
      last = raw.stamp;
    } catch (const DataError&) {
      fuzz::must(last && raw.stamp <= *last);
    }
  }
  return 0;
}
