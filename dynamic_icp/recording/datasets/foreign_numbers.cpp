// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/foreign_numbers.hpp"

#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSamples = 200;

bool is_foreign(double value) {
  constexpr double kLargest = 1e7;
  constexpr double kSmallest = 1e-20;
  return std::abs(value) > kLargest || (value != 0.0 && std::abs(value) < kSmallest);
}

/// The first of the foreign rows where they are most of those looked at; nothing where they are not.
std::optional<std::size_t> foreign_row(const RawScan& scan) {
  const std::size_t rows = scan.points.size();
  std::size_t finite = 0;
  std::size_t foreign = 0;
  std::size_t first = 0;
  for (std::size_t row = 0; row < rows; row += 1 + rows / kSamples) {
    const Eigen::Vector3d& p = scan.points[row];
    if (p.allFinite() && std::isfinite(scan.doppler[row])) {
      ++finite;
      if (is_foreign(p.x()) || is_foreign(p.y()) || is_foreign(p.z()) || is_foreign(scan.doppler[row])) {
        first = foreign == 0 ? row : first;
        ++foreign;
      }
    }
  }
  return 2 * foreign > finite ? std::optional(first) : std::nullopt;
}

std::string numbers_at(const RawScan& scan, std::size_t row) {
  const Eigen::Vector3d& p = scan.points[row];
  return fmt::format("has x, y, z = {:g}, {:g}, {:g} m and Doppler {:g} m/s, as have most", p.x(), p.y(), p.z(),
                     scan.doppler[row]);
}

}  // namespace

void refuse_foreign_numbers(const RawScan& scan, const fs::path& file, const formats::RecordLayout& layout) {
  if (const std::optional<std::size_t> row = foreign_row(scan)) {
    throw DataError(fmt::format("{}: record {} at byte {} {}: expected little-endian records of {} bytes ({})",
                                file.string(), *row, *row * layout.stored_bytes(), numbers_at(scan, *row),
                                layout.stored_bytes(), layout.name));
  }
}

void refuse_foreign_numbers(const RawScan& scan, const fs::path& file) {
  if (const std::optional<std::size_t> row = foreign_row(scan)) {
    throw DataError(
        fmt::format("{}: point {} {}: expected numbers in the byte order and of the types that the file says they are",
                    file.string(), *row, numbers_at(scan, *row)));
  }
}

}  // namespace dynamic_icp::datasets
