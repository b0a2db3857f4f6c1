// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/boreas_doppler_tables.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPartsName = "rt_part.csv";
constexpr std::string_view kTableFiles = "rt_part.csv, azi_minmax_0.csv to _3.csv and vel_mean_0.csv to _3.csv";
constexpr double kMaxAzimuthRad = std::numbers::pi + 1e-3;  // limits may be rounded
constexpr double kMinWidthRad = 1e-6;

std::string azimuths_name(std::size_t beam) { return fmt::format("azi_minmax_{}.csv", beam); }
std::string biases_name(std::size_t beam) { return fmt::format("vel_mean_{}.csv", beam); }

std::vector<std::string> table_names() {
  std::vector<std::string> names = {std::string(kPartsName)};
  for (std::size_t beam = 0; beam < kBoreasBeams; ++beam) {
    names.push_back(azimuths_name(beam));
    names.push_back(biases_name(beam));
  }
  return names;
}

/// Where tables of a recording may lie, the likeliest first.
std::vector<fs::path> table_folders(const fs::path& recording) {
  return {child(recording, "aeva_calib"), child(recording, "calib"), recording,
          child(named_path(recording).parent_path(), "aeva_calib")};
}

/// The first of these files that lies in one of the folders, or empty.
fs::path first_file(const std::vector<fs::path>& folders, const std::vector<std::string>& names) {
  for (const fs::path& folder : folders) {
    for (const std::string& name : names) {
      if (const fs::path file = folder.empty() ? fs::path() : child(folder, name); !file.empty()) {
        return file;
      }
    }
  }
  return {};
}

/// A line of a table.
struct TableRow {
  std::string place;
  std::vector<double> numbers;
};

std::vector<TableRow> read_table(const fs::path& folder, const std::string& name) {
  const fs::path path = child(folder, name);
  if (path.empty()) {
    throw DataError(fmt::format("{}: missing; tables of Doppler bias are {}", (folder / name).string(), kTableFiles));
  }
  std::vector<TableRow> rows;
  for (const auto& [place, line] : formats::read_lines(path)) {
    rows.push_back({place, numbers_in(line, place)});
    const std::vector<double>& numbers = rows.back().numbers;
    if (!std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); })) {
      throw DataError(fmt::format("{}: a number is not finite", place));
    }
  }
  if (rows.empty()) {
    throw DataError(fmt::format("{}: no numbers in this file", path.string()));
  }
  return rows;
}

void check_begins(const TableRow& begins, std::size_t beam, std::size_t parts) {
  // One more is the end of the last part.
  if (begins.numbers.size() != parts && begins.numbers.size() != parts + 1) {
    throw DataError(
        fmt::format("{}: {} numbers, expected the {} begins of parts for the {} lines of {}, or these and "
                    "the end of the last",
                    begins.place, begins.numbers.size(), parts, parts, azimuths_name(beam)));
  }
  const auto fall = std::adjacent_find(begins.numbers.begin(), begins.numbers.end(),
                                       [](double begin, double next) { return next <= begin; });
  if (fall != begins.numbers.end()) {
    throw DataError(fmt::format("{}: {} comes after {}, expected increasing shares of the scan's duration",
                                begins.place, *std::next(fall), *fall));
  }
}

void check_azimuths(const TableRow& limits) {
  if (limits.numbers.size() != 2) {
    throw DataError(fmt::format("{}: {} numbers, expected 2: least and greatest azimuth in rad", limits.place,
                                limits.numbers.size()));
  }
  const double least = limits.numbers[0];
  const double greatest = limits.numbers[1];
  if (greatest - least < kMinWidthRad || least < -kMaxAzimuthRad || greatest > kMaxAzimuthRad) {
    throw DataError(fmt::format("{}: azimuths from {} to {}, expected increasing ones from -pi to pi (rad)",
                                limits.place, least, greatest));
  }
}

std::vector<BoreasDopplerPart> read_beam(const fs::path& folder, std::size_t beam, const TableRow& begins) {
  const std::vector<TableRow> azimuths = read_table(folder, azimuths_name(beam));
  std::vector<TableRow> biases = read_table(folder, biases_name(beam));
  check_begins(begins, beam, azimuths.size());
  if (biases.size() != azimuths.size()) {
    throw DataError(fmt::format("{}: {} lines, expected {} as in {}: one per part of the scan",
                                (folder / biases_name(beam)).string(), biases.size(), azimuths.size(),
                                azimuths_name(beam)));
  }
  std::vector<BoreasDopplerPart> parts;
  for (std::size_t i = 0; i < azimuths.size(); ++i) {
    check_azimuths(azimuths[i]);
    if (const std::size_t cells = i == 0 ? biases[0].numbers.size() : parts[0].bias_mps.size();
        biases[i].numbers.size() != cells) {
      throw DataError(fmt::format("{}: {} numbers, expected {} as in the first line: one per cell of azimuth",
                                  biases[i].place, biases[i].numbers.size(), cells));
    }
    parts.push_back({begins.numbers[i], azimuths[i].numbers[0], azimuths[i].numbers[1], std::move(biases[i].numbers)});
  }
  return parts;
}

/// The earliest and the latest of the times that are finite; the first is the greater where there is none.
std::pair<double, double> span_of(const std::vector<double>& times) {
  std::pair<double, double> span(std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity());
  for (const double time : times) {
    if (std::isfinite(time)) {
      span = {std::min(span.first, time), std::max(span.second, time)};
    }
  }
  return span;
}

void warn_of_doppler(RawScan& scan, const fs::path& file, const std::string& what) {
  scan.warning += fmt::format("{}{}: {}", scan.warning.empty() ? "" : "; ", file.string(), what);
}

}  // namespace

fs::path find_boreas_doppler_tables(const fs::path& recording) {
  return first_file(table_folders(recording), table_names()).parent_path();
}

fs::path find_doppler_odom_model(const fs::path& recording) {
  return first_file(table_folders(recording), {"bias.bin", "sensor0_s1", "mean_elevation_beam_order_0"});
}

BoreasDopplerTables read_boreas_doppler_tables(const fs::path& folder) {
  const std::vector<TableRow> begins = read_table(folder, std::string(kPartsName));
  if (begins.size() != kBoreasBeams) {
    throw DataError(fmt::format("{}: {} lines, expected {}: one per beam", (folder / kPartsName).string(),
                                begins.size(), kBoreasBeams));
  }
  BoreasDopplerTables tables;
  for (std::size_t beam = 0; beam < kBoreasBeams; ++beam) {
    tables[beam] = read_beam(folder, beam, begins[beam]);
  }
  return tables;
}

double boreas_doppler_bias_mps(const std::vector<BoreasDopplerPart>& beam, double scan_share, double azimuth_rad) {
  // A share that is a limit is still of the part before it.
  const auto next = std::lower_bound(beam.begin() + 1, beam.end(), scan_share,
                                     [](const BoreasDopplerPart& part, double share) { return part.begin < share; });
  const BoreasDopplerPart& part = *std::prev(next);
  const auto cells = static_cast<double>(part.bias_mps.size());
  const double width_rad = (part.max_azimuth_rad - part.min_azimuth_rad) / cells;
  const double cell = std::floor((azimuth_rad - part.min_azimuth_rad) / width_rad);
  return part.bias_mps[static_cast<std::size_t>(std::clamp(cell, 0.0, cells - 1.0))];
}

void subtract_boreas_doppler_bias(const BoreasDopplerTables& tables, const fs::path& file, RawScan& scan) {
  const std::vector<std::uint16_t>& beams = scan.channels.line;
  if (scan.points.empty()) {
    return;
  }
  if (beams.empty() || scan.times.empty()) {
    warn_of_doppler(scan, file, "the Doppler keeps its bias: the tables go by beam and time, and the scan lacks them");
    return;
  }
  const auto [begin_s, end_s] = span_of(scan.times);
  const double duration_s = end_s - begin_s;
  std::size_t strange = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!scan.points[i].allFinite() || !std::isfinite(scan.times[i])) {
      continue;
    }
    if (beams[i] >= kBoreasBeams) {
      ++strange;
      continue;
    }
    const double share = duration_s > 0.0 ? (scan.times[i] - begin_s) / duration_s : 0.0;
    const double azimuth_rad = std::atan2(scan.points[i].y(), scan.points[i].x());
    scan.doppler[i] -= boreas_doppler_bias_mps(tables[beams[i]], share, azimuth_rad);
  }
  if (strange > 0) {
    warn_of_doppler(scan, file,
                    fmt::format("the Doppler of {} points keeps its bias: their beam is above {}, the last of the "
                                "tables",
                                strange, kBoreasBeams - 1));
  }
}

}  // namespace dynamic_icp::datasets
