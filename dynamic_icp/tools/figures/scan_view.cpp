// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/scan_view.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "dynamic_icp/method/base/quantile.hpp"

namespace dynamic_icp::figures {
namespace {

void include(drawing::Range& range, double low, double high) {
  range = {std::min(range.minimum, low), std::max(range.maximum, high)};
}

/// The middle share of `values`, without the outermost 1 - share on either side.
drawing::Range middle_part(const std::vector<double>& values, double share) {
  return {quantile(values, 1.0 - share), quantile(values, share)};
}

struct Coordinates {
  std::vector<double> x;
  std::vector<double> y;
};

Coordinates ground_coordinates(const Scan& scan, std::span<const std::uint32_t> rows) {
  Coordinates ground;
  for (const std::uint32_t row : rows) {
    ground.x.push_back(scan.points()[row].x());
    ground.y.push_back(scan.points()[row].y());
  }
  return ground;
}

}  // namespace

std::vector<std::uint32_t> rows_per_cell(const Scan& scan, double cell_m) {
  using Entry = std::tuple<double, double, double, std::uint32_t>;  // square along x and y, Doppler, row
  std::vector<Entry> entries;
  entries.reserve(scan.size());
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d& p = scan.points()[i];
    entries.emplace_back(std::floor(p.x() / cell_m), std::floor(p.y() / cell_m), scan.doppler()[i],
                         static_cast<std::uint32_t>(i));
  }
  std::sort(entries.begin(), entries.end());
  const auto same_cell = [](const Entry& a, const Entry& b) {
    return std::get<0>(a) == std::get<0>(b) && std::get<1>(a) == std::get<1>(b);
  };
  std::vector<std::uint32_t> rows;
  for (std::size_t begin = 0; begin < entries.size();) {
    std::size_t end = begin;
    while (end < entries.size() && same_cell(entries[begin], entries[end])) {
      ++end;
    }
    rows.push_back(std::get<3>(entries[begin + (end - begin) / 2]));
    begin = end;
  }
  return rows;
}

Region region_of_interest(const Scan& scan, std::span<const std::uint32_t> rows,
                          std::span<const runs::ObjectRow> objects) {
  const Coordinates ground = ground_coordinates(scan, rows);
  constexpr double kShownShare = 0.95;
  constexpr double kMarginM = 2.0;
  constexpr double kFarthestM = 150.0;  // beyond that a car is a few pixels
  Region region{middle_part(ground.x, kShownShare), middle_part(ground.y, kShownShare)};
  for (const runs::ObjectRow& object : objects) {
    const Eigen::Vector3d half = 0.5 * object.extent.cwiseAbs();
    const Eigen::Vector3d low = object.centroid - half;
    const Eigen::Vector3d high = object.centroid + half;
    if (low.allFinite() && high.allFinite()) {
      include(region.x, low.x(), high.x());
      include(region.y, low.y(), high.y());
    }
  }
  include(region.x, -3.0, 10.0);  // the sensor and the way ahead
  include(region.y, -6.0, 6.0);
  for (drawing::Range* range : {&region.x, &region.y}) {
    *range = {std::max(range->minimum, -kFarthestM) - kMarginM, std::min(range->maximum, kFarthestM) + kMarginM};
  }
  return region;
}

drawing::Range field_of_view(const Scan& scan) {
  std::vector<double> azimuths;
  for (const Eigen::Vector3d& u : scan.directions()) {
    azimuths.push_back(std::atan2(u.y(), u.x()));
  }
  constexpr double kNearlyAll = 0.999;
  return middle_part(azimuths, kNearlyAll);
}

std::vector<std::uint32_t> rows_on_object(const ScanView& view, const std::vector<double>& compensated,
                                          const runs::ObjectRow& object) {
  constexpr double kStationary_mps = 0.5;  // slower points count as standing still
  const double tolerance = std::max(kStationary_mps, 0.1 * object.velocity.norm());
  std::vector<std::uint32_t> rows;
  for (std::size_t i = 0; i < view.scan.size(); ++i) {
    if (!view.labels.empty()) {
      if (view.labels.at(view.scan.records()[i]) == object.id) {
        rows.push_back(static_cast<std::uint32_t>(i));
      }
      continue;
    }
    // The centroid is a mean: a point of the object can be a whole extent away from it.
    const Eigen::Vector3d away = (view.scan.points()[i] - object.centroid).cwiseAbs() - object.extent;
    const double expected = view.scan.directions()[i].dot(object.velocity);
    if (away.maxCoeff() <= 0.0 && std::abs(compensated[i]) > kStationary_mps &&
        std::abs(compensated[i] - expected) <= tolerance) {
      rows.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return rows;
}

Region footprint(const ScanView& view, std::span<const std::uint32_t> rows, const runs::ObjectRow& object) {
  constexpr std::size_t kEnough = 5;
  constexpr double kNearlyAll = 0.99;  // a few wrong rows must not blow up the box
  if (rows.size() < kEnough) {
    const Eigen::Vector3d low = object.centroid - 0.5 * object.extent.cwiseAbs();
    const Eigen::Vector3d high = object.centroid + 0.5 * object.extent.cwiseAbs();
    return {{low.x(), high.x()}, {low.y(), high.y()}};
  }
  const Coordinates ground = ground_coordinates(view.scan, rows);
  return {middle_part(ground.x, kNearlyAll), middle_part(ground.y, kNearlyAll)};
}

}  // namespace dynamic_icp::figures
