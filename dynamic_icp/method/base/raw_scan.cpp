// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/raw_scan.hpp"

#include <algorithm>
#include <stdexcept>

namespace dynamic_icp {
namespace {

Column coordinate(const std::vector<Eigen::Vector3d>& vectors, Eigen::Index axis) {
  return vectors.empty() ? Column{} : Column(&vectors.front()[axis], vectors.size(), sizeof(Eigen::Vector3d));
}

}  // namespace

VectorColumns::VectorColumns(const std::vector<Eigen::Vector3d>& vectors)
    : VectorColumns(coordinate(vectors, 0), coordinate(vectors, 1), coordinate(vectors, 2)) {}

ScanView::ScanView(const RawScan& raw)
    : stamp(raw.stamp),
      points(raw.points),
      doppler(raw.doppler),
      times(raw.times),
      directions(raw.directions),
      sensor(raw.channels.sensor),
      line(raw.channels.line),
      face(raw.channels.face),
      intensity(raw.channels.intensity),
      return_number(raw.channels.return_number),
      is_unusable(raw.is_unusable),
      mountings(raw.mountings),
      doppler_kind(raw.doppler_kind) {}

void check_columns(const ScanView& scan) {
  const std::size_t n = scan.points.size();
  std::string wrong;
  const auto check = [&](const char* name, std::size_t size, bool may_be_empty) {
    if (size != n && !(may_be_empty && size == 0)) {
      wrong += std::string(wrong.empty() ? "" : ", ") + std::to_string(size) + " " + name;
    }
  };
  check("y coordinates", scan.points.y.size(), false);
  check("z coordinates", scan.points.z.size(), false);
  check("Doppler values", scan.doppler.size(), false);
  check("times", scan.times.size(), true);
  check("directions", scan.directions.size(), true);
  check("y components of directions", scan.directions.y.size(), scan.directions.empty());
  check("z components of directions", scan.directions.z.size(), scan.directions.empty());
  check("sensor numbers", scan.sensor.size(), true);
  check("lines", scan.line.size(), true);
  check("mirror faces", scan.face.size(), true);
  check("intensities", scan.intensity.size(), true);
  check("return numbers", scan.return_number.size(), true);
  check("flags", scan.is_unusable.size(), true);
  if (!wrong.empty()) {
    throw std::invalid_argument("scan columns differ in length: " + std::to_string(n) + " points, " + wrong);
  }
  for (const Eigen::Isometry3d& mounting : scan.mountings) {
    if (!mounting.matrix().allFinite()) {
      throw std::invalid_argument("a mounting has numbers that are not finite");
    }
  }
  const bool has_mountings = !scan.mountings.empty();
  const auto largest = std::ranges::max_element(scan.sensor);
  if (has_mountings && (scan.sensor.empty() ? n > 0 : *largest >= scan.mountings.size())) {
    throw std::invalid_argument(scan.sensor.empty()
                                    ? "a scan with mountings needs the sensor of each point"
                                    : "a point is of sensor " + std::to_string(*largest) + ", but the scan has " +
                                          std::to_string(scan.mountings.size()) + " mountings");
  }
}

}  // namespace dynamic_icp
