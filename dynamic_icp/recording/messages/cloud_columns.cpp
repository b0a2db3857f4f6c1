// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/cloud_columns.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::messages {
namespace {

struct TypeRow {
  formats::NpyType type;
  std::string_view name;
};

// In the order of FieldType.
constexpr std::array<TypeRow, 10> kTypeRows = {{{formats::NpyType::kInt8, "int8"},
                                                {formats::NpyType::kUint8, "uint8"},
                                                {formats::NpyType::kInt16, "int16"},
                                                {formats::NpyType::kUint16, "uint16"},
                                                {formats::NpyType::kInt32, "int32"},
                                                {formats::NpyType::kUint32, "uint32"},
                                                {formats::NpyType::kFloat32, "float32"},
                                                {formats::NpyType::kFloat64, "float64"},
                                                {formats::NpyType::kInt64, "int64"},
                                                {formats::NpyType::kUint64, "uint64"}}};

const TypeRow& row_of(FieldType type) { return kTypeRows.at(static_cast<std::size_t>(type)); }

/// Whether `blocks` of `bytes` fit into what is there; none of the products may overflow.
bool fit(std::uint64_t blocks, std::uint64_t bytes, std::uint64_t available) {
  return blocks == 0 || bytes <= available / blocks;
}

void check_layout(const PointCloud& cloud, const std::string& origin) {
  for (const PointField& field : cloud.fields) {
    const std::uint64_t bytes = std::uint64_t{field.count} * size_of(field.type);
    if (bytes > cloud.point_step || field.offset > cloud.point_step - bytes) {
      throw DataError(fmt::format("{}: field '{}', {} x {} at byte {}, ends beyond a point of {} bytes", origin,
                                  field.name, field.count, name_of(field.type), field.offset, cloud.point_step));
    }
  }
  const std::uint64_t points = std::uint64_t{cloud.width} * cloud.height;  // both of 32 bits
  if (points == 0) {
    return;
  }
  if (cloud.point_step == 0) {
    throw DataError(fmt::format("{}: {} points of point_step 0, expected the bytes of a point", origin, points));
  }
  const std::uint64_t row_bytes = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.height > 1 && cloud.row_step < row_bytes) {
    throw DataError(fmt::format("{}: row_step {} bytes, expected {} or more for {} points of {} bytes", origin,
                                cloud.row_step, row_bytes, cloud.width, cloud.point_step));
  }
  // The last row need not be padded.
  const std::uint64_t last_row = cloud.height == 1 ? 0 : cloud.height - 1;
  if (!fit(1, row_bytes, cloud.data.size()) || !fit(last_row, cloud.row_step, cloud.data.size() - row_bytes)) {
    throw DataError(fmt::format("{}: {} bytes of data for {} x {} points of {} bytes (row_step {})", origin,
                                cloud.data.size(), cloud.height, cloud.width, cloud.point_step, cloud.row_step));
  }
}

}  // namespace

std::size_t size_of(FieldType type) { return formats::size_of(row_of(type).type); }

std::string_view name_of(FieldType type) { return row_of(type).name; }

CloudColumns::CloudColumns(PointCloud cloud, std::string origin)
    : cloud_(std::move(cloud)), origin_(std::move(origin)) {
  check_layout(cloud_, origin_);
  points_ = std::size_t{cloud_.width} * cloud_.height;
  for (const PointField& field : cloud_.fields) {
    if (!field.name.empty() && std::find(names_.begin(), names_.end(), field.name) == names_.end()) {
      names_.push_back(field.name);
    }
  }
}

formats::NpyArray CloudColumns::column(std::string_view name) const {
  const auto field = std::find_if(cloud_.fields.begin(), cloud_.fields.end(),
                                  [&](const PointField& candidate) { return candidate.name == name; });
  if (field == cloud_.fields.end()) {
    throw DataError(fmt::format("{}: has no field '{}'; there are: {}", origin_, name, fmt::join(names_, ", ")));
  }
  formats::NpyArray array{row_of(field->type).type, {points_}, {}, fmt::format("{}: field '{}'", origin_, name)};
  if (field->count > 1) {
    array.shape.push_back(field->count);
  }
  const std::size_t item_bytes = size_of(field->type);
  const std::size_t bytes = item_bytes * field->count;
  array.bytes.resize(points_ * bytes);
  char* next = array.bytes.data();
  formats::with_type(array.type, [&](auto zero) {  // copies of a size that is known are the fast ones
    for (std::size_t row = 0; points_ > 0 && row < cloud_.height; ++row) {
      const char* from = cloud_.data.data() + row * cloud_.row_step + field->offset;
      for (std::size_t i = 0; i < cloud_.width; ++i, from += cloud_.point_step, next += bytes) {
        for (std::size_t k = 0; k < bytes; k += sizeof(zero)) {
          std::memcpy(next + k, from + k, sizeof(zero));
          if (cloud_.is_bigendian) {
            std::reverse(next + k, next + k + sizeof(zero));
          }
        }
      }
    }
  });
  return array;
}

std::vector<double> CloudColumns::values(std::string_view name, std::size_t element) const {
  return formats::column_as_doubles(column(name), element);
}

}  // namespace dynamic_icp::messages
