// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/window/doppler_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/method/motion/deskew.hpp"

namespace dynamic_icp::window {
namespace {

constexpr std::size_t kNoiseAzimuths = 300;   // 1.2 degrees
constexpr std::size_t kNoiseElevations = 64;  // where the scan has no lines
constexpr double kMaxElevation = 0.5;         // rad; beyond it elevation hardly changes anything

// A cell tells how its points scatter with so many of them, and a bin of the noise with so many deviations.
constexpr double kInformativeCell = 5.0;
constexpr std::size_t kInformativeBin = 60;
constexpr double kNoiseGain = 0.35;
constexpr double kShrinkage = 1.15;  // the mean of a cell was taken from the same points
constexpr double kMinVariance = 1e-6;
constexpr double kHidden = 0.1;     // an azimuth shows what stands with this share of its points
constexpr double kFewPoints = 0.5;  // of the mean of azimuths: fewer may be false ones

/// Number of the direction sector around the vertical, to a thousandth of a sector; no trigonometry per point.
std::size_t azimuth_sector(double x, double y) {
  const double ax = std::abs(x);
  const double ay = std::abs(y);
  const double r = ax > ay ? ay / ax : (ay > 0.0 ? ax / ay : 0.0);
  // atan r = (pi/4) r + r (1 - r) (0.2447 + 0.0663 r), within 0.0015 rad
  double angle = r * (0.25 * std::numbers::pi + (1.0 - r) * (0.2447 + 0.0663 * r));
  angle = ax > ay ? angle : 0.5 * std::numbers::pi - angle;
  angle = x < 0.0 ? std::numbers::pi - angle : angle;
  angle = y < 0.0 ? -angle : angle;
  const double turn = angle / (2.0 * std::numbers::pi) + 0.5;
  return std::min(kNoiseAzimuths - 1,
                  static_cast<std::size_t>(std::max(0.0, turn) * static_cast<double>(kNoiseAzimuths)));
}

std::size_t elevation_step(double z) {
  const double share = 0.5 + 0.5 * std::clamp(z / kMaxElevation, -1.0, 1.0);
  return std::min(kNoiseElevations - 1, static_cast<std::size_t>(share * static_cast<double>(kNoiseElevations)));
}

std::vector<double> edges(std::vector<double> values, std::size_t bins) {
  std::sort(values.begin(), values.end());
  std::vector<double> result;
  for (std::size_t k = 1; k < bins && !values.empty(); ++k) {
    result.push_back(values[k * (values.size() - 1) / bins]);
  }
  return result;
}

std::size_t index_in(const std::vector<double>& edges, double value) {
  return static_cast<std::size_t>(std::upper_bound(edges.begin(), edges.end(), value) - edges.begin());
}

}  // namespace

std::size_t DopplerNoise::bin(double range_m, double intensity) const {
  return index_in(range_edges_m, range_m) * kIntensities + index_in(intensity_edges, intensity);
}

std::uint16_t DopplerCells::line_of(const Eigen::Vector3d& u) {
  return static_cast<std::uint16_t>(elevation_step(u.z()));
}

/// Points of one cell have the same sensor, line (or elevation), azimuth and time to the length of an interval.
void DopplerCells::sort(const Scan& scan, double interval_s, const Workers& workers) {
  const Channels& channels = scan.channels();
  const motion::TimeSpan span = motion::time_span(scan);
  const auto intervals = static_cast<std::size_t>((span.last - span.first) / interval_s) + 1;
  const std::size_t lines =
      channels.line.empty()
          ? kNoiseElevations
          : static_cast<std::size_t>(*std::max_element(channels.line.begin(), channels.line.end())) + 1;
  order_.keys.resize(scan.size());
  range_.resize(scan.size());
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    range_[i] = scan.points()[i].norm();
    const Eigen::Vector3d& u = scan.directions()[i];
    const std::size_t line = channels.line.empty() ? elevation_step(u.z()) : channels.line[i];
    const std::size_t sensor = channels.sensor.empty() ? 0 : channels.sensor[i];
    const std::size_t interval =
        scan.has_times()
            ? std::min(intervals - 1, static_cast<std::size_t>((scan.times()[i] - span.first) / interval_s))
            : 0;
    order_.keys[i] = ((sensor * intervals + interval) * lines + line) * kNoiseAzimuths + azimuth_sector(u.x(), u.y());
  });
  order_.sort();
  points_.resize(scan.size());
  workers.for_each(scan.size(), kPointBlock,
                   [&](std::size_t i) { points_[order_.place(i)] = static_cast<std::uint32_t>(i); });
  bin_.clear();
}

/// The bin of the noise for each point of the scan that was sorted; the first scan shows which bins there are.
void DopplerCells::find_bins(const Scan& scan, const Workers& workers) {
  const std::vector<float>& intensity = scan.channels().intensity;
  if (noise_.range_edges_m.empty()) {
    noise_.range_edges_m = edges(range_, DopplerNoise::kRanges);
    if (!intensity.empty()) {
      noise_.intensity_edges = edges({intensity.begin(), intensity.end()}, DopplerNoise::kIntensities);
    }
  }
  bin_.resize(scan.size());
  workers.for_each(scan.size(), kPointBlock, [&](std::size_t i) {
    const double shown = intensity.empty() ? 0.0 : static_cast<double>(intensity[i]);
    bin_[i] = static_cast<std::uint8_t>(noise_.bin(range_[i], shown));
  });
}

/// From how points scatter within their cells: any motion and any smooth error is the same for all of a cell.
void DopplerCells::learn_noise(const Scan& scan) {
  std::vector<std::vector<double>> samples(DopplerNoise::kRanges * DopplerNoise::kIntensities);
  const std::size_t stride = std::max<std::size_t>(1, scan.size() / 16384);
  for (std::size_t i = 0; i < scan.size(); i += stride) {
    if (std::isfinite(residual_[i]) && counts_[order_.cell[i]] >= kInformativeCell) {
      samples[bin_[i]].push_back(std::abs(residual_[i]));
    }
  }
  std::vector<double> all;
  for (const std::vector<double>& bin : samples) {
    all.insert(all.end(), bin.begin(), bin.end());
  }
  const auto variance_of = [](const std::vector<double>& values) {
    const double sigma = kSigmaPerMad * median(values);
    return std::max(kMinVariance, kShrinkage * sigma * sigma);
  };
  const bool is_first = noise_.variance.empty();
  const double common = all.size() >= kInformativeBin ? variance_of(all) : (is_first ? 0.01 : -1.0);
  noise_.variance.resize(samples.size(), common);
  for (std::size_t bin = 0; bin < samples.size() && common > 0.0; ++bin) {
    const double seen = samples[bin].size() >= kInformativeBin ? variance_of(samples[bin]) : common;
    noise_.variance[bin] += (is_first ? 1.0 : kNoiseGain) * (seen - noise_.variance[bin]);
  }
}

const std::vector<DopplerCell>& DopplerCells::average(const Scan& scan, const std::vector<std::uint8_t>& is_moving,
                                                      const std::vector<double>& measured,
                                                      const std::vector<double>& predicted, double gate_mps,
                                                      const Workers& workers) {
  counts_.assign(count(), 0.0);
  residual_.assign(scan.size(), std::numeric_limits<double>::quiet_NaN());
  workers.for_each(count(), kCellBlock, [&](std::size_t cell) {
    double sum = 0.0;
    for (const std::uint32_t i : points(cell)) {
      const double e = measured[i] - predicted[i];
      if (is_moving[i] == 0 && std::abs(e) < gate_mps) {
        residual_[i] = e;
        sum += e;
        counts_[cell] += 1.0;
      }
    }
    for (const std::uint32_t i : points(cell)) {
      residual_[i] -= sum / counts_[cell];
    }
  });
  if (bin_.empty()) {
    find_bins(scan, workers);
  }
  learn_noise(scan);
  cells_.resize(count());
  workers.for_each(count(), kCellBlock, [&](std::size_t cell) { cells_[cell] = mean_of(cell, scan, measured); });
  std::erase_if(cells_, [](const DopplerCell& cell) { return cell.points < 0.5; });
  return cells_;
}

std::vector<double> DopplerCells::hidden_azimuths(const Scan& scan) const {
  struct Azimuth {
    double seen = 0.0;
    double standing = 0.0;
  };
  std::vector<std::array<Azimuth, kNoiseAzimuths>> azimuths(std::max<std::size_t>(1, scan.mountings().size()));
  for (std::size_t cell = 0; cell < count(); ++cell) {
    const std::uint32_t point = points(cell).front();
    const std::size_t sensor = scan.channels().sensor.empty() ? 0 : scan.channels().sensor[point];
    Azimuth& azimuth = azimuths[sensor][order_.keys[point] % kNoiseAzimuths];
    azimuth.seen += static_cast<double>(points(cell).size());
    azimuth.standing += counts_[cell];
  }
  std::vector<double> hidden;
  for (const auto& of_sensor : azimuths) {
    double points = 0.0;
    double with_points = 0.0;
    for (const Azimuth& one : of_sensor) {
      points += one.seen;
      with_points += one.seen > 0.0 ? 1.0 : 0.0;
    }
    const double enough = kFewPoints * points / std::max(1.0, with_points);
    const auto in_view = [&](const Azimuth& one) { return one.seen > 0.0 && one.seen >= enough; };
    const auto count = std::ranges::count_if(of_sensor, in_view);
    const auto hides = std::ranges::count_if(
        of_sensor, [&](const Azimuth& one) { return in_view(one) && one.standing < kHidden * one.seen; });
    hidden.push_back(count > 0 ? static_cast<double>(hides) / static_cast<double>(count) : 0.0);
  }
  return hidden;
}

DopplerCell DopplerCells::mean_of(std::size_t cell, const Scan& scan, const std::vector<double>& measured) const {
  const Channels& channels = scan.channels();
  DopplerCell mean;
  for (const std::uint32_t i : points(cell)) {
    if (!std::isfinite(residual_[i])) {
      continue;
    }
    const double intensity = channels.intensity.empty() ? 0.0 : static_cast<double>(channels.intensity[i]);
    const double variance = noise_.variance[bin_[i]];
    const double inside = 1.0 - residual_[i] * residual_[i] / (kDopplerKernel * kDopplerKernel * variance);
    if (inside <= 0.0) {
      continue;
    }
    const double robust = inside * inside;
    const double w = robust / variance;
    const Eigen::Vector3d& u = scan.directions()[i];
    mean.u += w * u;
    mean.s += w * measured[i];
    mean.time_s += w * (scan.has_times() ? scan.times()[i] : 0.0);
    mean.range_m += w * range_[i];
    mean.intensity += w * intensity;
    mean.weight += w;
    mean.points += robust;
    mean.line = channels.line.empty() ? line_of(u) : channels.line[i];
    mean.face = channels.face.empty() ? std::uint8_t{0} : channels.face[i];
    mean.sensor = channels.sensor.empty() ? std::uint8_t{0} : channels.sensor[i];
  }
  if (mean.weight > 0.0) {
    const double scale = 1.0 / mean.weight;
    mean.u *= scale;
    mean.s *= scale;
    mean.time_s *= scale;
    mean.range_m *= scale;
    mean.intensity *= scale;
    if (scan.is_of_rig()) {
      mean.lxu = scan.mountings()[mean.sensor].translation().cross(mean.u);
    }
  }
  return mean;
}

void DopplerCells::state(StateArchive& archive) {
  archive(noise_.range_edges_m);
  archive.any_numbers(noise_.intensity_edges);
  archive(noise_.variance);
  archive.require(
      noise_.range_edges_m.size() < DopplerNoise::kRanges &&
          noise_.intensity_edges.size() < DopplerNoise::kIntensities &&
          (noise_.variance.empty() || noise_.variance.size() == DopplerNoise::kRanges * DopplerNoise::kIntensities) &&
          std::ranges::all_of(noise_.variance, [](double variance) { return variance > 0.0; }),
      "the noise of the Doppler");
}

}  // namespace dynamic_icp::window
