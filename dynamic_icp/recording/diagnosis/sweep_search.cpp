// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/diagnosis/sweep_search.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/recording/diagnosis/judging.hpp"
#include "dynamic_icp/recording/diagnosis/scan_look.hpp"

namespace dynamic_icp::diagnosis {
namespace {

constexpr std::size_t kStretches = 4;
constexpr std::size_t kScansOfStretch = 20;
constexpr std::size_t kMinScansToSearch = 10;
constexpr double kMaxScanPeriod_s = 2.0;  // scans farther apart do not show how the velocity changes

// Of the period: what takes less is no sweep, what takes more is no measurement, and what is nearer to one is one.
constexpr double kMinSweep = 0.4;
constexpr double kMaxSweep = 1.5;
constexpr double kWholePeriod = 0.08;

// Points that return nothing are not stored, so places in the azimuth are times where columns follow each other at an
// even rate, and places in the file are only nearly so: the latter must explain clearly more.
constexpr double kClearlyBetter = 0.7;

constexpr std::string_view kHypotheses[] = {"cannot_tell", "instant", "azimuth_ccw", "azimuth_cw", "as_stored"};

/// How many standard errors a measurement is beyond the least sweep; negative for what is shorter.
double margin_of(const motion::SweepDuration& measured, double period_s) {
  return (std::abs(measured.duration_s) - kMinSweep * period_s) / measured.sigma_s;
}

bool is_sweep(const motion::SweepDuration& measured, double period_s) {
  return margin_of(measured, period_s) > kCertain && std::abs(measured.duration_s) < kMaxSweep * period_s;
}

/// Longer beyond doubt than any sweep: what was taken for static is not, and nothing follows.
bool is_absurd(const motion::SweepDuration& measured, double period_s) {
  return std::abs(measured.duration_s) - kCertain * measured.sigma_s > kMaxSweep * period_s;
}

/// What a sweep takes by its measurement.
double sweep_duration(const motion::SweepDuration& measured, double period_s) {
  const double duration_s = std::abs(measured.duration_s);
  const double tolerance_s = std::max(kCertain * measured.sigma_s, kWholePeriod * period_s);
  return duration_s > period_s - tolerance_s ? period_s : duration_s;
}

std::string in_words(const motion::SweepDuration& measured) {
  return std::isfinite(measured.sigma_s)
             ? fmt::format("{:.0f} +- {:.0f} ms", 1e3 * measured.duration_s, 1e3 * measured.sigma_s)
             : "unknown";
}

std::string sentence_of(const SweepSearch& search) {
  const std::string measured = fmt::format("duration by the Doppler: {} counter-clockwise, {} as stored",
                                           in_words(search.by_azimuth), in_words(search.as_stored));
  const std::string sweep = fmt::format("in {:.3f} s ({})", search.duration_s, measured);
  switch (search.hypothesis) {
    case SweepHypothesis::kInstant:
      return fmt::format("the points have no times, and scans were taken in an instant ({})", measured);
    case SweepHypothesis::kAzimuthCcw:
      return "the points have no times, but were measured counter-clockwise (right to left) " + sweep;
    case SweepHypothesis::kAzimuthCw:
      return "the points have no times, but were measured clockwise (left to right) " + sweep;
    case SweepHypothesis::kAsStored:
      return "the points have no times, but were measured in the order in which they are stored " + sweep;
    case SweepHypothesis::kUnknown:
      break;
  }
  return fmt::format(
      "the points have no times, and the Doppler does not show whether scans were taken in an instant ({}): they are "
      "taken as instant",
      measured);
}

void decide(SweepSearch& search, double period_s) {
  const bool azimuth_fits = is_sweep(search.by_azimuth, period_s);
  const bool stored_fits = is_sweep(search.as_stored, period_s) && search.as_stored.duration_s > 0.0;
  const bool stored_is_better = kClearlyBetter * search.as_stored.explained > search.by_azimuth.explained;
  if (azimuth_fits || stored_fits) {
    const bool is_stored = stored_fits && (!azimuth_fits || stored_is_better);
    const motion::SweepDuration& measured = is_stored ? search.as_stored : search.by_azimuth;
    search.hypothesis = is_stored                   ? SweepHypothesis::kAsStored
                        : measured.duration_s > 0.0 ? SweepHypothesis::kAzimuthCcw
                                                    : SweepHypothesis::kAzimuthCw;
    search.duration_s = sweep_duration(measured, period_s);
    search.margin = margin_of(measured, period_s);
    return;
  }
  search.margin =
      std::max(0.0, -std::max(margin_of(search.by_azimuth, period_s), margin_of(search.as_stored, period_s)));
  search.hypothesis = search.margin > kCertain ? SweepHypothesis::kInstant : SweepHypothesis::kUnknown;
}

/// The sums of consecutive scans; a stretch ends where the Doppler gives no velocity and begins anew. False where the
/// points have times or the Doppler is compensated.
bool add_stretch(const datasets::Dataset& dataset, const datasets::ScanRange& scans, const Workers& workers,
                 std::vector<std::vector<motion::SweepSums>>& stretches) {
  stretches.emplace_back();
  for (std::size_t i = scans.begin; i < scans.end; ++i) {
    const RawScan raw = dataset.scan(i);
    if (!raw.times.empty() || raw.doppler_kind == DopplerKind::kCompensated) {
      return false;
    }
    const Scan scan = Scan::from_raw(raw, {}, workers);
    const DopplerFit fit = fit_doppler(scan, workers);
    if (fit.has_velocity()) {
      const double time_s = seconds_between(dataset.stamp(scans.begin), dataset.stamp(i));
      stretches.back().push_back(motion::sweep_sums(raw, scan, fit.static_rows, time_s, workers));
    } else if (!stretches.back().empty()) {
      stretches.emplace_back();
    }
  }
  return true;
}

}  // namespace

std::string_view to_string(SweepHypothesis hypothesis) { return kHypotheses[static_cast<std::size_t>(hypothesis)]; }

void declare(const SweepSearch& search, motion::SweepConfig& config) {
  config.declared_duration_s = search.duration_s;
  config.declared_left_to_right = search.hypothesis == SweepHypothesis::kAzimuthCw;
  config.declared_as_stored = search.hypothesis == SweepHypothesis::kAsStored;
}

SweepSearch judge_sweep(const motion::SweepDuration& by_azimuth, const motion::SweepDuration& as_stored,
                        double period_s) {
  SweepSearch search;
  search.by_azimuth = by_azimuth;
  search.as_stored = as_stored;
  if (!is_absurd(by_azimuth, period_s) && !is_absurd(as_stored, period_s)) {
    decide(search, period_s);
  }
  search.sentence = sentence_of(search);
  return search;
}

std::optional<SweepSearch> search_sweep(const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                                        double period_s, const Workers& workers) {
  if (scans.size() < kMinScansToSearch || !(period_s > 0.0 && period_s <= kMaxScanPeriod_s)) {
    return std::nullopt;
  }
  const std::size_t count = std::clamp<std::size_t>(scans.size() / kScansOfStretch, 1, kStretches);
  const std::size_t length = count < kStretches ? scans.size() / count : kScansOfStretch;
  std::vector<std::vector<motion::SweepSums>> stretches;
  SweepSearch search;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = scans.begin + (count > 1 ? k * (scans.size() - length) / (count - 1) : 0);
    if (!add_stretch(dataset, {begin, begin + length}, workers, stretches)) {
      return std::nullopt;
    }
    search = judge_sweep(motion::sweep_duration(stretches, motion::PointOrder::kAzimuth, period_s),
                         motion::sweep_duration(stretches, motion::PointOrder::kAsStored, period_s), period_s);
    search.scans = (k + 1) * length;
    if (search.hypothesis != SweepHypothesis::kUnknown) {
      break;
    }
  }
  return search;
}

}  // namespace dynamic_icp::diagnosis
