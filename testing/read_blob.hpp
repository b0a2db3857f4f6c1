// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <zlib.h>

// For the tests of this room: reads the data of a page as docs/report.md describes them, sharing nothing with what
// writes them.
namespace dynamic_icp::report {

inline std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') {
      break;
    }
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) {
      throw std::runtime_error("no base64");
    }
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes.push_back(static_cast<char>(bits >> count & 0xff));
    }
  }
  return bytes;
}

inline std::string inflated(const std::string& stream) {
  z_stream zip{};
  if (inflateInit(&zip) != Z_OK) {
    throw std::runtime_error("zlib");
  }
  std::vector<unsigned char> input(stream.begin(), stream.end());
  zip.next_in = input.data();
  zip.avail_in = static_cast<uInt>(input.size());
  std::string bytes;
  int status = Z_OK;
  while (status == Z_OK) {
    unsigned char buffer[4096];
    zip.next_out = buffer;
    zip.avail_out = sizeof buffer;
    status = inflate(&zip, Z_NO_FLUSH);
    bytes.append(reinterpret_cast<const char*>(buffer), sizeof buffer - zip.avail_out);
  }
  inflateEnd(&zip);
  if (status != Z_STREAM_END || zip.avail_in != 0) {
    throw std::runtime_error("no whole zlib stream");
  }
  return bytes;
}

/// Numbers one after the other; for little-endian machines.
class Bytes {
 public:
  explicit Bytes(std::string bytes) : bytes_(std::move(bytes)) {}

  template <class Number>
  Number next() {
    Number number;
    if (at_ + sizeof number > bytes_.size()) {
      throw std::runtime_error("too short");
    }
    std::memcpy(&number, bytes_.data() + at_, sizeof number);
    at_ += sizeof number;
    return number;
  }
  [[nodiscard]] bool at_end() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

struct ReadScan {
  double unit = 0.0;
  std::vector<Eigen::Vector3d> points;
  std::vector<double> doppler;
  std::vector<std::int16_t> compensated;
  std::vector<int> labels;
  std::vector<int> residual;
};

inline ReadScan read_scan_blob(const std::string& blob) {
  Bytes bytes(inflated(from_base64(blob)));
  const auto n = bytes.next<std::uint32_t>();
  ReadScan scan;
  scan.unit = static_cast<double>(bytes.next<float>());
  scan.points.resize(n);
  for (int axis = 0; axis < 3; ++axis) {
    std::int16_t value = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      value = static_cast<std::int16_t>(value + bytes.next<std::int16_t>());
      scan.points[i][axis] = scan.unit * value;
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    scan.doppler.push_back(0.01 * bytes.next<std::int16_t>());
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    scan.compensated.push_back(bytes.next<std::int16_t>());
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    scan.labels.push_back(bytes.next<std::uint8_t>());
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    scan.residual.push_back(bytes.next<std::uint8_t>());
  }
  if (!bytes.at_end()) {
    throw std::runtime_error("too long");
  }
  return scan;
}

inline std::vector<Eigen::Vector3d> read_map_blob(const std::string& blob) {
  Bytes bytes(inflated(from_base64(blob)));
  const auto n = bytes.next<std::uint32_t>();
  const double unit = static_cast<double>(bytes.next<float>());
  Eigen::Vector3d origin;
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = bytes.next<double>();
  }
  std::vector<Eigen::Vector3d> points(n);
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      value += bytes.next<std::uint32_t>();
      points[i][axis] = origin[axis] + unit * static_cast<std::int32_t>(value);
    }
  }
  if (!bytes.at_end()) {
    throw std::runtime_error("too long");
  }
  return points;
}

}  // namespace dynamic_icp::report
