// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "testing/npz_by_hand.hpp"

// For tests: point clouds out of a ROS 1 bag (format 2.0, chunks not compressed), by the published format.
namespace dynamic_icp::ros1 {

/// A sensor_msgs/PointCloud2 and the time at which it was recorded.
struct BagCloud {
  std::int64_t recorded_ns = 0;
  std::vector<std::pair<std::string, std::uint32_t>> fields;  ///< name and offset in a point; all float32 here
  std::uint32_t point_bytes = 0;
  std::string points;

  /// One number of each point; throws std::out_of_range where there is no such field.
  [[nodiscard]] std::vector<float> values(const std::string& name) const {
    for (const auto& [field, offset] : fields) {
      if (field == name) {
        std::vector<float> numbers;
        for (std::size_t at = offset; at < points.size(); at += point_bytes) {
          numbers.push_back(formats::number_in<float>(points, at));
        }
        return numbers;
      }
    }
    throw std::out_of_range(name);
  }
};

/// Takes numbers and texts from the front of bytes; throws std::out_of_range at their end.
class Cursor {
 public:
  explicit Cursor(std::string bytes, std::size_t at = 0) : bytes_(std::move(bytes)), at_(at) {}

  [[nodiscard]] bool is_done() const { return at_ >= bytes_.size(); }

  template <class Number>
  Number number() {
    at_ += sizeof(Number);
    return formats::number_in<Number>(bytes_, at_ - sizeof(Number));
  }

  /// Bytes behind their number.
  std::string text() {
    const auto size = number<std::uint32_t>();
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

 private:
  std::string bytes_;
  std::size_t at_;
};

/// Names and values of a header.
inline std::map<std::string, std::string> header_of(const std::string& bytes) {
  std::map<std::string, std::string> fields;
  for (Cursor cursor(bytes); !cursor.is_done();) {
    const std::string field = cursor.text();
    const std::size_t equals = field.find('=');
    fields[field.substr(0, equals)] = field.substr(equals + 1);
  }
  return fields;
}

inline BagCloud cloud_of(const std::string& message, const std::string& time) {
  constexpr std::size_t kSequenceAndStamp = 12;
  BagCloud cloud;
  cloud.recorded_ns =
      1'000'000'000LL * formats::number_in<std::uint32_t>(time, 0) + formats::number_in<std::uint32_t>(time, 4);
  Cursor cursor(message, kSequenceAndStamp);
  cursor.text();                   // frame
  cursor.number<std::uint64_t>();  // height and width
  for (auto left = cursor.number<std::uint32_t>(); left > 0; --left) {
    std::string name = cursor.text();
    cloud.fields.emplace_back(std::move(name), cursor.number<std::uint32_t>());
    cursor.number<std::uint8_t>();   // type
    cursor.number<std::uint32_t>();  // count
  }
  cursor.number<std::uint8_t>();  // byte order
  cloud.point_bytes = cursor.number<std::uint32_t>();
  cursor.number<std::uint32_t>();  // bytes of a row
  cloud.points = cursor.text();
  return cloud;
}

/// All clouds of a bag, given its bytes, in its order.
inline std::vector<BagCloud> clouds_of(const std::string& bag) {
  constexpr char kMessage = 2;
  constexpr char kChunk = 5;
  constexpr char kConnection = 7;
  std::vector<BagCloud> clouds;
  std::map<std::string, std::string> types;
  for (Cursor file(bag, bag.find('\n') + 1); !file.is_done();) {
    const char kind = header_of(file.text()).at("op").at(0);
    const std::string content = file.text();
    for (Cursor chunk(kind == kChunk ? content : ""); !chunk.is_done();) {
      const std::map<std::string, std::string> header = header_of(chunk.text());
      const std::string data = chunk.text();
      const std::string& connection = header.at("conn");
      if (header.at("op").at(0) == kConnection) {
        types[connection] = header_of(data).at("type");
      } else if (header.at("op").at(0) == kMessage && types.at(connection) == "sensor_msgs/PointCloud2") {
        clouds.push_back(cloud_of(data, header.at("time")));
      }
    }
  }
  return clouds;
}

}  // namespace dynamic_icp::ros1
