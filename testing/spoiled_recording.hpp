// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/diagnosis/diagnosis.hpp"

#include "testing/synthetic_rig.hpp"
#include "testing/synthetic_street.hpp"

// A recording whose numbers are wrong in a known way, and its diagnosis.
namespace dynamic_icp::diagnosis {

namespace synthetic = odometry::synthetic;
using datasets::Correction;
using datasets::DopplerSign;
using Eigen::Vector3d;

inline constexpr double kPeriod_s = 0.1;
inline constexpr std::size_t kScans = 25;

/// A drive by equations, spoiled on the way out.
class Recording final : public datasets::Dataset {
 public:
  synthetic::World world = synthetic::street_with_cars();
  synthetic::Path path = synthetic::agile(9.0);
  synthetic::Sensor sensor;
  synthetic::Mountings rig;               ///< empty: one sensor at the origin
  std::vector<double> rig_bias_mps = {};  ///< of each sensor, or empty
  bool has_truth = true;
  double truth_scale = 1.0;
  double stamp_factor = 1.0;
  DopplerKind kind = DopplerKind::kRelative;
  std::function<void(RawScan&, const Vector3d& velocity)> perturb = [](RawScan&, const Vector3d&) {};

  /// Once all is set.
  Recording& ready() {
    for (std::size_t i = 0; has_truth && i < kScans; ++i) {
      truth_.push_back({stamp(i), path(static_cast<double>(i) * kPeriod_s)});
      truth_.back().T_world_sensor.translation() *= truth_scale;
    }
    return *this;
  }

  [[nodiscard]] std::string_view format() const override { return "test"; }
  [[nodiscard]] std::size_t size() const override { return kScans; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override {
    return synthetic::stamp_at(stamp_factor * static_cast<double>(index) * kPeriod_s);
  }
  [[nodiscard]] std::filesystem::path scan_file(std::size_t) const override { return "scan"; }
  [[nodiscard]] RawScan scan(std::size_t index) const override {
    const double time_s = static_cast<double>(index) * kPeriod_s;
    RawScan raw = rig.empty() ? synthetic::scan_at(world, path, sensor, time_s).raw
                              : synthetic::rig_scan(world, path, sensor, rig, rig_bias_mps, time_s);
    raw.stamp = stamp(index);
    perturb(raw, synthetic::velocity_sensor(path, time_s));
    return raw;
  }
  [[nodiscard]] DopplerKind doppler_kind() const override { return kind; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_; }
  [[nodiscard]] std::filesystem::path ground_truth_file() const override { return {}; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return none_; }

 private:
  formats::Trajectory truth_;
  std::vector<std::string> none_;
};

inline Diagnosis diagnosis_of(Recording& recording, int threads = 1) {
  DiagnosisConfig config;
  config.probes = 4;
  return diagnose(recording.ready(), config, Workers(threads));
}

/// With what was applied to the recording.
inline Diagnosis diagnosis_of(std::unique_ptr<Recording> recording, const Correction& applied) {
  recording->ready();
  DiagnosisConfig config;
  config.probes = 4;
  config.applied = applied;
  return diagnose(*datasets::corrected(std::move(recording), applied), config, Workers(1));
}

/// The verdicts that are not "ok", by question.
inline std::map<std::string, std::string> not_ok(const Diagnosis& diagnosis) {
  std::map<std::string, std::string> verdicts;
  for (const Finding& finding : diagnosis.findings) {
    if (finding.verdict != Verdict::kOk) {
      verdicts[std::string(to_string(finding.question))] = to_string(finding.verdict);
    }
  }
  return verdicts;
}

using Verdicts = std::map<std::string, std::string>;

inline void flip(RawScan& raw, const Vector3d&) {
  for (double& doppler : raw.doppler) {
    doppler = -doppler;
  }
}

inline void compensate(RawScan& raw, const Vector3d& velocity) {
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    raw.doppler[i] += raw.points[i].normalized().dot(velocity);
  }
}

inline void to_millimetres(RawScan& raw, const Vector3d&) {
  for (Vector3d& point : raw.points) {
    point *= 1000.0;
  }
}

inline void to_doppler_x_y_z(RawScan& raw, const Vector3d&) {
  for (std::size_t i = 0; i < raw.points.size(); ++i) {
    const Vector3d p = raw.points[i];
    raw.points[i] = {raw.doppler[i], p.x(), p.y()};
    raw.doppler[i] = p.z();
  }
}

}  // namespace dynamic_icp::diagnosis
