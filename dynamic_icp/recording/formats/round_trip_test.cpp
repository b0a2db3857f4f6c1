// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// What is written is read back, whatever it is: random files that shrink to the smallest one that fails.
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include "dynamic_icp/recording/formats/npz.hpp"
#include "dynamic_icp/recording/formats/pcd_read.hpp"
#include "dynamic_icp/recording/formats/ply.hpp"
#include "dynamic_icp/recording/formats/point_records.hpp"
#include "dynamic_icp/recording/formats/point_table.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/xyzd_bin.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

/// A file that is removed at the end.
struct TemporaryFile {
  TemporaryFile() : path(fs::temp_directory_path() / ("round_trip_test-" + std::to_string(::getpid()))) {}
  ~TemporaryFile() { fs::remove(path); }
  fs::path path;
};

std::size_t below(std::size_t end) { return *rc::gen::inRange<std::size_t>(0, end); }

float any_float() { return std::bit_cast<float>(*rc::gen::arbitrary<std::uint32_t>()); }

bool same(double read, float written) {
  return std::isnan(written)
             ? std::isnan(read)
             : std::bit_cast<std::uint64_t>(read) == std::bit_cast<std::uint64_t>(static_cast<double>(written));
}

/// Any numbers of a type: all bits are some.
NpyArray any_array(std::size_t rows, std::size_t columns, std::size_t types) {
  NpyArray array;
  array.type = static_cast<NpyType>(below(types));
  array.shape = columns == 1 ? std::vector<std::size_t>{rows} : std::vector<std::size_t>{rows, columns};
  const std::size_t bytes = rows * columns * size_of(array.type);
  array.bytes = *rc::gen::container<std::string>(bytes, rc::gen::arbitrary<char>());
  return array;
}

std::vector<NamedArray> any_table(std::size_t max_columns, std::size_t types) {
  const std::size_t rows = below(12);
  std::vector<NamedArray> table;
  const std::size_t columns = 1 + below(5);
  for (std::size_t k = 0; k < columns; ++k) {
    table.push_back({fmt::format("column_{}", k), any_array(rows, 1 + below(max_columns), types)});
  }
  return table;
}

constexpr std::size_t kTypes = 10;

void must_be_equal(const NpyArray& read, const NpyArray& written) {
  RC_ASSERT(read.type == written.type);
  RC_ASSERT(read.shape == written.shape);
  RC_ASSERT(read.bytes == written.bytes);
}

RC_GTEST_PROP(RoundTrip, Npy, ()) {
  const NpyArray array = any_array(below(20), 1 + below(5), kTypes);
  must_be_equal(parse_npy(npy_bytes(array), "array"), array);
}

RC_GTEST_PROP(RoundTrip, Npz, ()) {
  const std::vector<NamedArray> members = any_table(4, kTypes);
  const TemporaryFile file;
  write_npz(file.path, members);
  const NpzFile archive(file.path);
  RC_ASSERT(archive.names().size() == members.size());
  for (const NamedArray& member : members) {
    RC_ASSERT(archive.why_no_numbers(member.name).empty());
    must_be_equal(archive.read(member.name), member.array);
  }
}

RC_GTEST_PROP(RoundTrip, Pcd, ()) {
  const std::vector<NamedArray> table = any_table(4, kTypes);
  const PcdFile file(pcd_bytes(table), "scan.pcd");
  RC_ASSERT(file.names().size() == table.size());
  for (const NamedArray& column : table) {
    must_be_equal(file.read(column.name), column.array);
  }
}

RC_GTEST_PROP(RoundTrip, Ply, ()) {
  std::vector<NamedArray> table = any_table(1, kTypes);
  std::erase_if(table, [](const NamedArray& column) {
    return column.array.type == NpyType::kInt64 || column.array.type == NpyType::kUint64;
  });
  RC_PRE(!table.empty());
  const PlyFile file = parse_ply(ply_bytes(table), "scan.ply");
  for (const NamedArray& column : table) {
    const std::vector<double> written = column_as_doubles(column.array);
    const PlyColumn* const read = file.find("vertex")->find(column.name);
    RC_ASSERT(read != nullptr && read->values.size() == written.size());
    for (std::size_t i = 0; i < written.size(); ++i) {
      RC_ASSERT(read->values[i] == written[i] || (std::isnan(read->values[i]) && std::isnan(written[i])));
    }
  }
}

RC_GTEST_PROP(RoundTrip, Tum, ()) {
  constexpr std::int64_t kLargest = 4'000'000'000'000'000'000;
  const auto stamps = *rc::gen::nonEmpty(
      rc::gen::container<std::set<std::int64_t>>(rc::gen::inRange<std::int64_t>(-kLargest, kLargest)));
  const auto number = [] { return static_cast<double>(*rc::gen::arbitrary<std::int32_t>()) / 1024.0; };
  Trajectory poses;
  for (const std::int64_t ns : stamps) {
    const Eigen::Vector3d turn = Eigen::Vector3d(number(), number(), number());
    StampedPose pose{Stamp{ns}, Eigen::Isometry3d::Identity()};
    pose.T_world_sensor = Eigen::Translation3d(number(), number(), number()) *
                          Eigen::AngleAxisd(turn.norm(), turn.stableNormalized().isZero() ? Eigen::Vector3d::UnitX()
                                                                                          : turn.stableNormalized());
    poses.push_back(pose);
  }
  const Trajectory read = parse_tum(format_tum(poses, "poses.txt"), "poses.txt").trajectory;
  RC_ASSERT(read.size() == poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    RC_ASSERT(read[i].stamp == poses[i].stamp);
    RC_ASSERT(read[i].T_world_sensor.translation() == poses[i].T_world_sensor.translation());
    RC_ASSERT(read[i].T_world_sensor.linear().isApprox(poses[i].T_world_sensor.linear(), 1e-14));
  }
}

RC_GTEST_PROP(RoundTrip, Xyzd, ()) {
  RawScan scan;
  std::vector<float> numbers;
  const std::size_t points = below(20);
  for (std::size_t i = 0; i < points; ++i) {
    for (int k = 0; k < 4; ++k) {
      numbers.push_back(any_float());
    }
    const float* const last = &numbers[numbers.size() - 4];
    scan.points.emplace_back(last[0], last[1], last[2]);
    scan.doppler.push_back(last[3]);
  }
  const TemporaryFile file;
  write_xyzd(file.path, scan);
  const RawScan read = read_xyzd(file.path);
  RC_ASSERT(read.points.size() == scan.points.size());
  for (std::size_t i = 0; i < read.points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      RC_ASSERT(same(read.points[i][static_cast<Eigen::Index>(k)], numbers[4 * i + k]));
    }
    RC_ASSERT(same(read.doppler[i], numbers[4 * i + 3]));
  }
}

RC_GTEST_PROP(RoundTrip, RecordsOfEveryLayout, ()) {
  for (const RecordLayout* layout : {&kXyzd, &kAeva25, &kAeva29, &kBoreas24, &kBoreas28, &kBoreas32, &kXyzdTime}) {
    std::string bytes;
    const std::size_t points = below(20);
    for (std::size_t i = 0; i < points * layout->bytes; ++i) {
      bytes += static_cast<char>(*rc::gen::arbitrary<std::uint8_t>());
    }
    const TemporaryFile file;
    std::ofstream(file.path, std::ios::binary) << bytes;
    const RawScan scan = read_points(file.path, *layout);
    RC_ASSERT(scan.points.size() == points);
    for (std::size_t i = 0; i < points; ++i) {
      const auto number = [&](std::size_t offset) {
        float value = 0.0F;
        std::memcpy(&value, bytes.data() + i * layout->bytes + offset, sizeof(value));
        return value;
      };
      for (std::size_t k = 0; k < 3; ++k) {
        RC_ASSERT(same(scan.points[i][static_cast<Eigen::Index>(k)], number(4 * k)));
      }
      RC_ASSERT(same(scan.doppler[i], number(layout->doppler)));
    }
  }
}

}  // namespace
}  // namespace dynamic_icp::formats
