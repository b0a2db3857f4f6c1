// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <Eigen/Geometry>

// For tests: messages of ROS written by the published rules, without the code under test.
namespace dynamic_icp::ros {

enum class Wire { kRos1, kCdrLittle, kCdrBig };

/// Puts numbers and texts one after the other.
class Writer {
 public:
  explicit Writer(Wire wire) : wire_(wire) {
    if (wire != Wire::kRos1) {
      bytes_ = std::string("\0", 1) + (wire == Wire::kCdrLittle ? '\1' : '\0') + std::string(2, '\0');
    }
  }

  template <class Number>
  Writer& put(Number number) {
    // Aligned to its own size, from behind the four bytes in front.
    while (wire_ != Wire::kRos1 && (bytes_.size() - 4) % sizeof(Number) != 0) {
      bytes_ += '\0';
    }
    char raw[sizeof(Number)];
    std::memcpy(raw, &number, sizeof(Number));
    if (wire_ == Wire::kCdrBig) {
      std::reverse(raw, raw + sizeof(Number));
    }
    bytes_.append(raw, sizeof(Number));
    return *this;
  }

  Writer& text(const std::string& text) {
    const std::string ended = wire_ == Wire::kRos1 ? text : text + '\0';
    put(static_cast<std::uint32_t>(ended.size()));
    bytes_ += ended;
    return *this;
  }

  Writer& blob(const std::string& blob) {
    put(static_cast<std::uint32_t>(blob.size()));
    bytes_ += blob;
    return *this;
  }

  Writer& doubles(std::size_t count, double value = 0.0) {
    for (std::size_t k = 0; k < count; ++k) {
      put(value);
    }
    return *this;
  }

  Writer& header(std::int64_t stamp_ns, const std::string& frame) {
    if (wire_ == Wire::kRos1) {
      put(std::uint32_t{7});  // seq
    }
    put(static_cast<std::uint32_t>(stamp_ns / 1'000'000'000));
    put(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
    return text(frame);
  }

  /// Translation or position, then x, y, z, w.
  Writer& pose(const Eigen::Isometry3d& T) {
    const Eigen::Quaterniond q(T.linear());
    for (const double number :
         {T.translation().x(), T.translation().y(), T.translation().z(), q.x(), q.y(), q.z(), q.w()}) {
      put(number);
    }
    return *this;
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  Wire wire_;
  std::string bytes_;
};

struct Field {
  std::string name;
  std::uint32_t offset;
  std::uint8_t datatype;  ///< 7: FLOAT32, 8: FLOAT64, ...
  std::uint32_t count = 1;
};

/// A sensor_msgs/PointCloud2.
struct Cloud {
  std::int64_t stamp_ns = 0;
  std::string frame = "lidar";
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<Field> fields = {};
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::string data = {};

  [[nodiscard]] std::string bytes(Wire wire) const {
    Writer writer(wire);
    writer.header(stamp_ns, frame).put(height).put(width).put(static_cast<std::uint32_t>(fields.size()));
    for (const Field& field : fields) {
      writer.text(field.name).put(field.offset).put(field.datatype).put(field.count);
    }
    writer.put(static_cast<std::uint8_t>(is_bigendian)).put(point_step).put(row_step).blob(data);
    return writer.put(std::uint8_t{1}).bytes();
  }
};

/// A cloud of float32 fields, one row of numbers a point.
inline Cloud float_cloud(std::int64_t stamp_ns, const std::string& frame, const std::vector<std::string>& names,
                         const std::vector<std::vector<float>>& points) {
  Cloud cloud;
  cloud.stamp_ns = stamp_ns;
  cloud.frame = frame;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.point_step = static_cast<std::uint32_t>(4 * names.size());
  cloud.row_step = cloud.point_step * cloud.width;
  for (const std::string& name : names) {
    cloud.fields.push_back({name, static_cast<std::uint32_t>(4 * cloud.fields.size()), 7});
  }
  for (const std::vector<float>& point : points) {
    cloud.data.append(reinterpret_cast<const char*>(point.data()), 4 * point.size());
  }
  return cloud;
}

}  // namespace dynamic_icp::ros
