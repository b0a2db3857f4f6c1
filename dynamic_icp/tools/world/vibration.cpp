// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/world/vibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/world/drive.hpp"
#include "dynamic_icp/tools/world/sine_wave.hpp"

namespace dynamic_icp::world {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kMillimetre = 1e-3;
constexpr std::size_t kAxes = 6;  // x, y, z (m), roll, pitch, yaw (rad)
constexpr std::size_t kWavesPerBand = 3;

/// A displacement or angle and its time derivative.
struct Value {
  double value = 0.0;
  double rate = 0.0;
};

/// What follows a hit of a wheel, with a largest value of 1.
class Bump {
 public:
  explicit Bump(double time_s) : time_s_(time_s) {
    double largest = 0.0;
    for (double t = 0.0; t < 4.0 * kDecay_s; t += 1e-4) {
      largest = std::max(largest, raw(t).value);
    }
    scale_ = 1.0 / largest;
  }

  [[nodiscard]] Value at(double time_s) const {
    const Value value = raw(time_s - time_s_);
    return {scale_ * value.value, scale_ * value.rate};
  }

 private:
  static constexpr double kDecay_s = 0.03;
  static constexpr double kOmega = 2.0 * pi * 10.0;

  /// Begins with value and rate 0.
  static Value raw(double t) {
    if (t <= 0.0) {
      return {};
    }
    const double fall = std::exp(-t / kDecay_s);
    const double envelope = fall * (1.0 - fall);
    const double envelope_rate = fall * (2.0 * fall - 1.0) / kDecay_s;
    return {envelope * std::sin(kOmega * t),
            envelope_rate * std::sin(kOmega * t) + envelope * kOmega * std::cos(kOmega * t)};
  }

  double time_s_;
  double scale_ = 1.0;
};

/// The displacement of the shaking body over time.
class Vibration {
 public:
  Vibration(const VibrationConfig& config, const RandomSource& random) : config_(config), bump_(config.bump_s) {
    std::uint64_t stream = 0;
    for (const VibrationBand& band : {config.body, config.wheel, config.engine}) {
      for (std::size_t axis = 0; axis < kAxes; ++axis) {
        const double amplitude = axis < 3 ? kMillimetre * band.amplitude_mm : kDegree * band.amplitude_deg;
        for (std::size_t i = 0; i < kWavesPerBand; ++i, stream += 2) {
          if (amplitude > 0.0) {
            waves_[axis].push_back({amplitude / std::sqrt(static_cast<double>(kWavesPerBand)),
                                    2.0 * pi * random.uniform(stream, band.low_hz, band.high_hz),
                                    random.uniform(stream + 1, 0.0, 2.0 * pi)});
          }
        }
      }
    }
  }

  [[nodiscard]] MotionState at(double time_s) const {
    std::array<Value, kAxes> axes;
    for (std::size_t axis = 0; axis < kAxes; ++axis) {
      for (const SineWave& wave : waves_[axis]) {
        axes[axis].value += wave.value(time_s);
        axes[axis].rate += wave.rate(time_s);
      }
    }
    const Value bump = bump_.at(time_s);
    axes[2].value += kMillimetre * config_.bump_mm * bump.value;
    axes[2].rate += kMillimetre * config_.bump_mm * bump.rate;
    axes[4].value += kDegree * config_.bump_deg * bump.value;
    axes[4].rate += kDegree * config_.bump_deg * bump.rate;
    return lift({{axes[0].value, axes[1].value}, {axes[0].rate, axes[1].rate}, axes[5].value, axes[5].rate},
                {axes[2].value, axes[4].value, axes[3].value, axes[2].rate, axes[4].rate, axes[3].rate});
  }

 private:
  VibrationConfig config_;
  std::array<std::vector<SineWave>, kAxes> waves_;
  Bump bump_;
};

bool shakes(const VibrationConfig& config) {
  for (const VibrationBand& band : {config.body, config.wheel, config.engine}) {
    if (band.amplitude_mm != 0.0 || band.amplitude_deg != 0.0) {
      return true;
    }
  }
  return config.bump_mm != 0.0 || config.bump_deg != 0.0;
}

ConfigFields fields(VibrationBand& band) {
  return {
      {"low_hz", &band.low_hz, 0.0, 1000.0, "Hz", "lowest frequency"},
      {"high_hz", &band.high_hz, 0.0, 1000.0, "Hz", "highest frequency"},
      {"amplitude_mm", &band.amplitude_mm, 0.0, 100.0, "mm", "of each direction, as of one sine"},
      {"amplitude_deg", &band.amplitude_deg, 0.0, 5.0, "deg", "of roll, pitch and yaw, as of one sine"},
  };
}

}  // namespace

ConfigFields fields(VibrationConfig& config) {
  ConfigFields list;
  append_fields(list, "body", fields(config.body));
  append_fields(list, "wheel", fields(config.wheel));
  append_fields(list, "engine", fields(config.engine));
  list.push_back({"bump_s", &config.bump_s, 0.0, 1e6, "s", "when a wheel meets a kerb or a pothole"});
  list.push_back({"bump_mm", &config.bump_mm, -500.0, 500.0, "mm", "the bump throws the vehicle up by this"});
  list.push_back({"bump_deg", &config.bump_deg, -10.0, 10.0, "deg", "the bump turns its nose down by this"});
  return list;
}

void check(VibrationConfig config) {
  check_fields(fields(config));
  for (const VibrationBand& band : {config.body, config.wheel, config.engine}) {
    if (band.low_hz > band.high_hz) {
      throw UsageError("configuration key 'low_hz' of a band of the vibration must not be above its 'high_hz'");
    }
  }
}

Trajectory vibrating(Trajectory body, const Eigen::Isometry3d& T_body_pivot, const VibrationConfig& config,
                     const RandomSource& random) {
  if (!shakes(config)) {
    return body;
  }
  return [body = std::move(body), T_body_pivot, T_pivot_body = T_body_pivot.inverse(),
          vibration = Vibration(config, random)](double time_s) {
    const MotionState pivot = moving_part(mounted(body(time_s), T_body_pivot), vibration.at(time_s));
    return mounted(pivot, T_pivot_body);
  };
}

}  // namespace dynamic_icp::world
