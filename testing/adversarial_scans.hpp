// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/scan.hpp"
#include "dynamic_icp/method/odometry/frame.hpp"

// Scans as a damaged file, a wrong unit or a broken driver makes them, and what must hold of the frames they give.
namespace dynamic_icp::adversarial {

/// A drive in a hall with a moving box, of which some scans are replaced by degenerate shapes, some numbers by NaN,
/// infinities, denormals and numbers near the limits of float, double and scan_limits.hpp, and some steps of the stamp
/// by steps of nanoseconds or years. In a third of the drives several sensors are said to have measured the points.
class ScanGenerator {
 public:
  /// The first choices are made by the bytes of `script`, all others by the seed.
  explicit ScanGenerator(std::uint64_t seed, std::span<const std::uint8_t> script = {});

  RawScan next();

 private:
  std::uint64_t bits();
  std::size_t choose(std::size_t count);
  double uniform(double low, double high);
  bool one_in(std::size_t count) { return choose(count) == 0; }
  double special_number();
  Stamp next_stamp();
  void fill_hall(RawScan& raw, std::size_t size);
  void fill_shape(RawScan& raw, std::size_t size);
  void replace_column(RawScan& raw);
  void damage(RawScan& raw);
  void make_rig(RawScan& raw) const;

  RandomSource random_;
  std::uint64_t drawn_ = 0;
  std::span<const std::uint8_t> script_;
  bool swept_;
  DopplerKind kind_;
  Stamp stamp_;
  bool rig_;
  int scans_ = 0;
};

/// What is wrong with a frame, whatever its scan was: a number that is not finite, a rotation that is none, an "ok" for
/// a motion that nothing makes. `dt_s` is the time since the last scan.
std::optional<std::string> fault_of(const odometry::Frame& frame, const RawScan& raw, double dt_s);

}  // namespace dynamic_icp::adversarial
