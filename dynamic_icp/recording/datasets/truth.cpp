// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/truth.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr double kLargeCoordinate = 1e4;  // m
constexpr double kRotationTolerance = 1e-3;

bool overlap(const formats::Trajectory& poses, const std::vector<Stamp>& stamps) {
  return !poses.empty() && !stamps.empty() && poses.front().stamp <= stamps.back() &&
         poses.back().stamp >= stamps.front();
}

}  // namespace

formats::Trajectory near_origin(formats::Trajectory poses) {
  if (!poses.empty()) {
    const Eigen::Vector3d first = poses.front().T_world_sensor.translation();
    if (first.cwiseAbs().maxCoeff() > kLargeCoordinate) {
      for (formats::StampedPose& pose : poses) {
        pose.T_world_sensor.translation() -= first;
      }
    }
  }
  return poses;
}

Truth named_truth(std::span<const fs::path> files, const std::vector<Stamp>& stamps,
                  std::vector<std::string>& assumptions) {
  for (const fs::path& file : files) {
    if (file.empty() || !fs::exists(file)) {
      continue;
    }
    formats::TumFile read = formats::read_tum(file);
    if (!overlap(read.trajectory, stamps)) {
      assumptions.push_back(fmt::format(
          "{}: its poses from {} to {} s are of another time than the scans from {} to {} s: not used as ground truth",
          file.string(), format_seconds(read.trajectory.front().stamp), format_seconds(read.trajectory.back().stamp),
          format_seconds(stamps.front()), format_seconds(stamps.back())));
      continue;
    }
    if (read.repeated_lines > 0) {
      assumptions.push_back(
          fmt::format("{}: {} lines repeat the one before and were left out", file.string(), read.repeated_lines));
    }
    return {near_origin(std::move(read.trajectory)), file};
  }
  return {};
}

Eigen::Isometry3d rigid_transform(std::span<const double> numbers, const std::string& place) {
  if (numbers.size() != 12 && numbers.size() != 16) {
    throw DataError(fmt::format("{}: {} numbers, expected the 12 of a 3x4 or the 16 of a 4x4 matrix, row by row", place,
                                numbers.size()));
  }
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  const Eigen::Map<const Rows> rows(numbers.data());
  const Eigen::Matrix3d R = rows.leftCols<3>();
  const bool is_rotation = rows.allFinite() &&
                           (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() <= kRotationTolerance &&
                           R.determinant() > 0.0;
  if (!is_rotation) {
    throw DataError(fmt::format("{}: the first three columns are no rotation within {:g}", place, kRotationTolerance));
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  // The nearest rotation, so that products of many poses stay rigid.
  T.linear() = Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T.translation() = rows.rightCols<1>();
  return T;
}

std::vector<double> numbers_in(std::string_view line, const std::string& place) {
  std::string spaced(line);
  std::replace(spaced.begin(), spaced.end(), ',', ' ');
  std::vector<double> numbers;
  for (const std::string_view word : formats::words_of(spaced)) {
    const std::optional<double> number = parse_number<double>(word);
    if (!number) {
      throw DataError(fmt::format("{}: {} is no number", place, formats::quoted_text(word)));
    }
    numbers.push_back(*number);
  }
  return numbers;
}

}  // namespace dynamic_icp::datasets
