// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/tum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr std::array<std::string_view, 8> kColumns = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
constexpr std::string_view kLayout = "timestamp tx ty tz qx qy qz qw";
constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr double kQuaternionTolerance = 1e-3;
// Half of the range of 64 bits, so that the difference of any two stamps fits as well: 146 years around 1970.
constexpr std::int64_t kMaxStampNs = std::numeric_limits<std::int64_t>::max() / 2;

/// One line as it stands in the file: tx ty tz qx qy qz qw after the stamp.
struct Row {
  Stamp stamp;
  std::array<double, 7> numbers{};

  bool operator==(const Row&) const = default;
};

/// A place in a file, for messages.
struct Place {
  std::string_view file;
  std::size_t line = 0;
};

[[noreturn]] void fail(const Place& place, const std::string& message) {
  throw DataError(fmt::format("{}: line {}: {}", place.file, place.line, message));
}

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

/// The columns of a line; two commas with nothing between them enclose an empty column.
std::vector<std::string_view> split_columns(std::string_view line) {
  std::vector<std::string_view> columns;
  line = without_blanks(line.substr(0, line.find('#')));
  bool after_comma = false;
  while (!line.empty() || after_comma) {
    const std::size_t length = std::min(line.find_first_of(" \t\r\v\f,"), line.size());
    columns.push_back(line.substr(0, length));
    line = without_blanks(line.substr(length));
    after_comma = !line.empty() && line.front() == ',';
    if (after_comma) {
      line = without_blanks(line.substr(1));
    }
  }
  return columns;
}

bool in_range(Stamp stamp) { return stamp.ns <= kMaxStampNs && stamp.ns >= -kMaxStampNs; }

Stamp parse_stamp(const Place& place, std::string_view text) {
  std::optional<Stamp> stamp = parse_seconds(text);
  if (!stamp) {
    stamp = parse_unix_time(text);  // cannot be seconds: beyond the range of a stamp
  }
  if (!stamp || !in_range(*stamp)) {
    fail(place, fmt::format("the time stamp is {}, expected seconds up to {} or Unix time in whole nanoseconds",
                            quoted_text(text), kMaxStampNs / 1'000'000'000));
  }
  return *stamp;
}

double finite_number(const Place& place, std::string_view column, std::string_view text) {
  const std::optional<double> number = parse_number<double>(text);
  if (!number || !std::isfinite(*number)) {
    fail(place, fmt::format("{} is {}, expected a finite number", column, quoted_text(text)));
  }
  return *number;
}

Row parse_row(const Place& place, const std::vector<std::string_view>& columns) {
  if (columns.size() != kColumns.size()) {
    fail(place, fmt::format("{} columns, expected {}: {}", columns.size(), kColumns.size(), kLayout));
  }
  Row row;
  row.stamp = parse_stamp(place, columns[0]);
  for (std::size_t k = 0; k < row.numbers.size(); ++k) {
    row.numbers[k] = finite_number(place, kColumns[k + 1], columns[k + 1]);
  }
  return row;
}

StampedPose pose_of(const Place& place, const Row& row) {
  const auto& [tx, ty, tz, qx, qy, qz, qw] = row.numbers;
  const Eigen::Quaterniond q(qw, qx, qy, qz);
  const double length = q.coeffs().stableNorm();
  if (!(std::abs(length - 1.0) <= kQuaternionTolerance)) {
    fail(place, fmt::format("the quaternion qx qy qz qw has length {:.6g}, expected 1 within {:g}", length,
                            kQuaternionTolerance));
  }
  StampedPose pose;
  pose.stamp = row.stamp;
  pose.T_world_sensor.linear() = q.normalized().toRotationMatrix();
  pose.T_world_sensor.translation() = Eigen::Vector3d(tx, ty, tz);
  return pose;
}

void check_order(const Place& place, Stamp previous, Stamp stamp) {
  if (stamp < previous) {
    fail(place, fmt::format("the time stamp {} comes after {}, expected increasing stamps", format_seconds(stamp),
                            format_seconds(previous)));
  }
  if (stamp == previous) {
    fail(place, fmt::format("the time stamp {} occurs a second time with another pose, expected increasing stamps",
                            format_seconds(stamp)));
  }
}

}  // namespace

TumFile parse_tum(std::string_view text, std::string_view name) {
  if (const FileKind kind = kind_of(text); kind != FileKind::kUnknown) {
    throw DataError(fmt::format("{}: line 1: the file {}; expected poses ({})", name, sentence(kind), kLayout));
  }
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.remove_prefix(3);  // the byte order mark some editors put in front
  }
  TumFile file;
  std::optional<Row> previous;
  for (Place place{name, 1}; !text.empty(); ++place.line) {
    const std::vector<std::string_view> columns = split_columns(take_line(text).value_or(""));
    if (columns.empty()) {
      continue;
    }
    const Row row = parse_row(place, columns);
    if (previous == row) {
      ++file.repeated_lines;
      continue;
    }
    if (previous) {
      check_order(place, previous->stamp, row.stamp);
    }
    file.trajectory.push_back(pose_of(place, row));
    previous = row;
  }
  if (file.trajectory.empty()) {
    throw DataError(fmt::format("{}: line 1: no pose in this file, expected lines: {}", name, kLayout));
  }
  return file;
}

TumFile read_tum(const std::filesystem::path& path) { return parse_tum(read_text_file(path), path.string()); }

std::string format_tum_line(const StampedPose& pose, std::string_view name) {
  const Eigen::Matrix3d R = pose.T_world_sensor.linear();
  const Eigen::Vector3d t = pose.T_world_sensor.translation();
  const bool is_rotation = (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() <= kQuaternionTolerance &&
                           R.determinant() > 0.0;  // false for NaN
  if (!t.allFinite() || !is_rotation || !in_range(pose.stamp)) {
    throw DataError(fmt::format("{}: the pose at {} s cannot be written, expected finite numbers and a rotation", name,
                                format_seconds(pose.stamp)));
  }
  Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  if (q.w() < 0.0) {
    q.coeffs() = -q.coeffs();
  }
  std::string line = format_seconds(pose.stamp);
  for (const double number : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) {
    line += fmt::format(" {}", number + 0.0);  // + 0.0 turns -0 into 0
  }
  return line + '\n';
}

std::string format_tum(const Trajectory& trajectory, std::string_view name) {
  if (trajectory.empty()) {
    throw DataError(fmt::format("{}: no pose to write, expected at least one", name));
  }
  std::string text;
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    if (k > 0) {
      check_order({name, k + 1}, trajectory[k - 1].stamp, trajectory[k].stamp);
    }
    text += format_tum_line(trajectory[k], name);
  }
  return text;
}

void write_tum(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_whole_file(path, format_tum(trajectory, path.string()));
}

}  // namespace dynamic_icp::formats
