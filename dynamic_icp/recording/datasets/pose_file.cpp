// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/pose_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/datasets/truth.hpp"
#include "dynamic_icp/recording/formats/csv.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kKittiColumns = 12;
constexpr const char* kPoseColumns[] = {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

bool is_among(std::string_view text, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

/// Which of the columns of a pose a name stands for; empty: none.
std::string meaning_of(const std::string& column) {
  std::string name = lower(column);
  std::erase_if(name, [](char c) { return c == '_' || c == '.' || c == ' '; });
  if (is_among(name, {"t", "timestamp", "time", "stamp", "timestampns", "timens", "timestampus", "timestampms",
                      "timeus", "timems", "times", "timestamps", "stampns", "headerstamp", "rosbagtimestamp"})) {
    return "t";
  }
  if (name.size() < 1 || std::string_view("xyzw").find(name.back()) == std::string_view::npos) {
    return "";
  }
  const std::string axis(1, name.back());
  name.pop_back();
  const auto ends = [&](std::string_view ending) { return name.ends_with(ending); };
  if (axis != "w" &&
      (is_among(name, {"", "t", "p", "pos"}) || ends("position") || ends("translation") || ends("prsr"))) {
    return axis;
  }
  return name == "q" || ends("quat") || ends("quaternion") || ends("orientation") || ends("rotation") || ends("qrs")
             ? "q" + axis
             : "";
}

std::optional<Stamp> stamp_in(std::string_view cell, std::string_view name) {
  struct Unit {
    std::string_view ending;
    std::int64_t ns;
  };
  constexpr Unit kStampUnits[] = {{"ns", 1}, {"us", 1000}, {"ms", 1'000'000}};
  if (const std::optional<std::int64_t> whole = parse_number<std::int64_t>(cell)) {
    for (const Unit& unit : kStampUnits) {
      if (name.ends_with("_" + std::string(unit.ending))) {
        constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max() / 2;
        return std::abs(static_cast<double>(*whole)) < static_cast<double>(kMost / unit.ns)
                   ? std::optional(Stamp{*whole * unit.ns})
                   : std::nullopt;
      }
    }
  }
  // Whole numbers that are too large for seconds are Unix time.
  const std::optional<Stamp> seconds = parse_seconds(cell);
  return seconds ? seconds : parse_unix_time(cell);
}

/// What a line of a table says in the words of TUM's layout.
std::string tum_line(const std::vector<std::string_view>& cells, const std::map<std::string, std::size_t>& where,
                     const std::string& time_name, const std::string& place) {
  const std::optional<Stamp> stamp = stamp_in(cells[where.at("t")], time_name);
  if (!stamp) {
    throw DataError(fmt::format("{}: the time is {}, expected seconds or Unix time in whole ms, us or ns", place,
                                formats::quoted_text(cells[where.at("t")])));
  }
  std::string line = format_seconds(*stamp);
  for (std::size_t k = 1; k < std::size(kPoseColumns); ++k) {
    line += ' ';
    line += cells[where.at(kPoseColumns[k])];
  }
  return line;
}

/// A table with a header: its lines in TUM's layout, empty ones where it has none, so that the numbers of lines stay.
std::string as_tum(std::string_view text, const formats::CsvHeader& header, const std::string& origin) {
  std::map<std::string, std::size_t> where;
  for (std::size_t k = 0; k < header.names.size(); ++k) {
    if (const std::string meaning = meaning_of(header.names[k]); !meaning.empty()) {
      where.emplace(meaning, k);
    }
  }
  for (const char* column : kPoseColumns) {
    if (!where.contains(column)) {
      throw DataError(
          fmt::format("{}: has no column for {} among {}; expected a time (timestamp), a position (x, y, z) "
                      "and a quaternion (qx, qy, qz, qw)",
                      origin, column, fmt::join(header.names, ", ")));
    }
  }
  std::string tum(header.first_line - 1, '\n');
  std::string_view rest = text.substr(header.begin);
  for (std::size_t line = header.first_line; const std::optional<std::string_view> next = formats::take_line(rest);
       ++line) {
    if (const std::vector<std::string_view> words = formats::words_of(*next);
        !words.empty() && !words.front().starts_with('#')) {
      const std::string place = fmt::format("{}: line {}", origin, line);
      const std::vector<std::string_view> cells = formats::cells_of(*next, header.delimiter);
      if (cells.size() != header.names.size()) {
        throw DataError(fmt::format("{}: {} columns, expected {}", place, cells.size(), header.names.size()));
      }
      tum += tum_line(cells, where, lower(header.names[where.at("t")]), place);
    }
    tum += '\n';
  }
  return tum;
}

PoseFile from_tum(const formats::TumFile& tum) { return {tum.trajectory, true, tum.repeated_lines}; }

PoseFile read_kitti(const fs::path& path) {
  PoseFile file;
  file.has_stamps = false;
  for (const formats::PlacedLine& line : formats::read_lines(path)) {
    file.poses.push_back({Stamp{}, rigid_transform(numbers_in(line.text, line.place), line.place)});
  }
  const fs::path times = path.parent_path() / "times.txt";
  if (!fs::exists(times)) {
    return file;
  }
  const std::vector<formats::PlacedLine> lines = formats::read_lines(times);
  if (lines.size() != file.poses.size()) {
    return file;
  }
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<std::string_view> words = formats::words_of(lines[i].text);
    const std::optional<Stamp> stamp = words.size() == 1 ? stamp_in(words.front(), "") : std::nullopt;
    if (!stamp || (i > 0 && *stamp <= file.poses[i - 1].stamp)) {
      throw DataError(fmt::format("{}: expected one time in seconds, later than the one before", lines[i].place));
    }
    file.poses[i].stamp = *stamp;
  }
  file.has_stamps = true;
  return file;
}

}  // namespace

PoseFile read_pose_file(const fs::path& path) {
  const std::string text = formats::read_text_file(path);
  std::optional<formats::CsvHeader> header;
  try {
    header = formats::parse_csv_header(text, path.string());
  } catch (const DataError&) {  // what is no table is no TUM either: its reader says what is wrong
  }
  if (header && header->names.empty() && header->columns == kKittiColumns) {
    return read_kitti(path);
  }
  const auto says_pose = [](const std::string& name) { return meaning_of(name) == "qw" || meaning_of(name) == "x"; };
  if (header && std::any_of(header->names.begin(), header->names.end(), says_pose)) {
    return from_tum(formats::parse_tum(as_tum(text, *header, path.string()), path.string()));
  }
  return from_tum(formats::parse_tum(text, path.string()));
}

formats::Trajectory read_truth(const fs::path& path, const std::vector<Stamp>& scans) {
  PoseFile file = read_pose_file(path);
  if (!file.has_stamps) {
    if (file.poses.size() != scans.size()) {
      throw DataError(
          fmt::format("{}: {} poses without times for {} scans, expected one for each scan; or a times.txt "
                      "beside it with as many times",
                      path.string(), file.poses.size(), scans.size()));
    }
    for (std::size_t i = 0; i < scans.size(); ++i) {
      file.poses[i].stamp = scans[i];
    }
  }
  return std::move(file.poses);
}

std::vector<Stamp> stamps_of(const Dataset& dataset) {
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    stamps.push_back(dataset.stamp(i));
  }
  return stamps;
}

std::vector<Stamp> stamps_of(const formats::Trajectory& trajectory) {
  std::vector<Stamp> stamps(trajectory.size());
  std::transform(trajectory.begin(), trajectory.end(), stamps.begin(),
                 [](const formats::StampedPose& pose) { return pose.stamp; });
  return stamps;
}

}  // namespace dynamic_icp::datasets
