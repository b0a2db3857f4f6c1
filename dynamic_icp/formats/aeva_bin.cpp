// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/formats/aeva_bin.hpp"

#include <string>
#include <string_view>

#include "dynamic_icp/formats/binary_file.hpp"

namespace dynamic_icp::formats {
namespace {

constexpr double kNanosecond = 1e-9;  // s

AevaRecord decode(std::string_view record, AevaRecordKind kind) {
  AevaRecord result;
  result.x = value_at<float>(record, 0);
  result.y = value_at<float>(record, 4);
  result.z = value_at<float>(record, 8);
  result.reflectivity = value_at<float>(record, 12);
  result.velocity = value_at<float>(record, 16);
  result.time_offset_ns = value_at<std::int32_t>(record, 20);
  result.line_index = value_at<std::uint8_t>(record, 24);
  if (kind == AevaRecordKind::kWithIntensity) {
    result.intensity = value_at<float>(record, 25);
  }
  return result;
}

void encode(std::string& bytes, const AevaRecord& record) {
  append_value(bytes, record.x);
  append_value(bytes, record.y);
  append_value(bytes, record.z);
  append_value(bytes, record.reflectivity);
  append_value(bytes, record.velocity);
  append_value(bytes, record.time_offset_ns);
  append_value(bytes, record.line_index);
  append_value(bytes, record.intensity);
}

}  // namespace

AevaScan read_aeva(const std::filesystem::path& path, AevaRecordKind kind) {
  const std::size_t size = record_bytes(kind);
  const RecordFile file = read_record_file(path, size);
  AevaScan scan;
  scan.raw.warning = file.warning;
  for (std::size_t i = 0; i < file.records; ++i) {
    const AevaRecord record = decode(std::string_view(file.bytes).substr(i * size, size), kind);
    scan.raw.points.emplace_back(record.x, record.y, record.z);
    scan.raw.doppler.push_back(record.velocity);
    scan.raw.times.push_back(kNanosecond * record.time_offset_ns);
    scan.reflectivity.push_back(record.reflectivity);
    scan.line_index.push_back(record.line_index);
    if (kind == AevaRecordKind::kWithIntensity) {
      scan.intensity.push_back(record.intensity);
    }
  }
  return scan;
}

void write_aeva(const std::filesystem::path& path, std::span<const AevaRecord> records) {
  std::string bytes;
  bytes.reserve(records.size() * record_bytes(AevaRecordKind::kWithIntensity));
  for (const AevaRecord& record : records) {
    encode(bytes, record);
  }
  write_bytes(path, std::as_bytes(std::span(bytes)));
}

}  // namespace dynamic_icp::formats
