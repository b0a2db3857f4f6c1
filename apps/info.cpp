// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/base/scan.hpp"
#include "dynamic_icp/datasets/dataset.hpp"

#include "apps/commands.hpp"
#include "apps/doppler_check.hpp"

namespace dynamic_icp::apps {
namespace {

constexpr std::size_t kScansLookedAt = 10;
constexpr double kGapPeriods = 1.5;
constexpr std::size_t kGapsShown = 5;

struct InfoOptions {
  std::string input;
  std::string format = "auto";
};

void print_time(const datasets::Dataset& dataset) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < dataset.size(); ++i) {
    periods.push_back(seconds_between(dataset.stamp(i - 1), dataset.stamp(i)));
  }
  if (periods.empty()) {
    fmt::print("time         one scan at {} s\n", format_seconds(dataset.stamp(0)));
    return;
  }
  std::vector<double> sorted = periods;
  std::sort(sorted.begin(), sorted.end());
  const double period = sorted[sorted.size() / 2];
  fmt::print("time         {} to {} s, {:.3f} s in all\n", format_seconds(dataset.stamp(0)),
             format_seconds(dataset.stamp(dataset.size() - 1)),
             seconds_between(dataset.stamp(0), dataset.stamp(dataset.size() - 1)));
  fmt::print("rate         {:.2f} Hz (periods {:.1f} to {:.1f} ms)\n", 1.0 / period, 1e3 * sorted.front(),
             1e3 * sorted.back());
  std::size_t gaps = 0;
  for (std::size_t i = 0; i < periods.size(); ++i) {
    if (periods[i] > kGapPeriods * period && ++gaps <= kGapsShown) {
      fmt::print("gap          {:.3f} s before scan {}\n", periods[i], i + 1);
    }
  }
  if (gaps > kGapsShown) {
    fmt::print("gap          {} more\n", gaps - kGapsShown);
  }
}

void print_points(const datasets::Dataset& dataset) {
  const std::size_t count = std::min(kScansLookedAt, dataset.size());
  std::vector<std::size_t> sizes;
  Scan::Dropped dropped;
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  double slowest = std::numeric_limits<double>::infinity();
  double fastest = -std::numeric_limits<double>::infinity();
  bool times = false;
  for (std::size_t k = 0; k < count; ++k) {
    const RawScan raw = dataset.scan((2 * k + 1) * dataset.size() / (2 * count));
    Scan::Dropped here;
    const Scan scan = Scan::from_raw(raw, &here);
    sizes.push_back(raw.points.size());
    dropped.non_finite += here.non_finite;
    dropped.zero_range += here.zero_range;
    times = times || scan.has_times();
    for (std::size_t i = 0; i < scan.size(); ++i) {
      nearest = std::min(nearest, scan.points()[i].norm());
      farthest = std::max(farthest, scan.points()[i].norm());
      slowest = std::min(slowest, scan.doppler()[i]);
      fastest = std::max(fastest, scan.doppler()[i]);
    }
    if (!raw.warning.empty()) {
      fmt::print("warning      {}\n", raw.warning);
    }
  }
  std::sort(sizes.begin(), sizes.end());
  fmt::print("points       {} to {} a scan, median {} (of {} scans looked at)\n", sizes.front(), sizes.back(),
             sizes[sizes.size() / 2], count);
  fmt::print("unusable     {} not finite, {} at the origin\n", dropped.non_finite, dropped.zero_range);
  if (farthest > 0.0) {
    fmt::print("range        {:.1f} to {:.1f} m\n", nearest, farthest);
    fmt::print("Doppler      {:.1f} to {:.1f} m/s\n", slowest, fastest);
  }
  fmt::print("point times  {}\n", times ? "yes" : "none");
}

int info(const InfoOptions& options) {
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_dataset(options.input, {.format = options.format});
  fmt::print("input        {}\n", options.input);
  fmt::print("format       {}\n", dataset->format());
  fmt::print("scans        {}\n", dataset->size());
  print_time(*dataset);
  print_points(*dataset);
  if (dataset->ground_truth().empty()) {
    fmt::print("ground truth none\n");
  } else {
    fmt::print("ground truth {} ({} poses)\n", dataset->ground_truth_file().string(), dataset->ground_truth().size());
  }
  const DopplerCheck check = check_doppler(*dataset, Workers());
  fmt::print("Doppler kind {}\n", check.verdict);
  if (check.scans > 0) {
    fmt::print("             static scene: {:.1f} % of the points within 0.5 m/s, median residual {:.3f} m/s\n",
               100.0 * check.inlier_share, check.median_residual_mps);
  }
  for (const std::string& assumption : dataset->assumptions()) {
    fmt::print("assumed      {}\n", assumption);
  }
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, std::function<int()>& selected) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = app.add_subcommand(
      "info", "What the program sees in a recording: layout, scans, times, ranges, sign of the Doppler");
  command->add_option("INPUT", options->input, "Folder of the recording")->required();
  command
      ->add_option(
          "--format", options->format,
          fmt::format("Layout of the recording: auto, {} (default auto)", fmt::join(datasets::known_formats(), ", ")))
      ->type_name("NAME");
  command->callback([options, &selected] { selected = [options] { return info(*options); }; });
}

}  // namespace dynamic_icp::apps
