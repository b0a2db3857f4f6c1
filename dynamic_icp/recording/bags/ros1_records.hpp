// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/bags/byte_source.hpp"

// The records of ROS 1 bags, format 2.0 (wiki.ros.org/Bags/Format/2.0): a header of named fields, then data.
namespace dynamic_icp::bags {

constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

enum class Ros1Op : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndexData = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7
};

struct Ros1Record {
  std::uint64_t at = 0;
  Ros1Op op = Ros1Op::kMessage;
  std::string header;
  std::uint64_t data_at = 0;
  std::uint64_t data_size = 0;

  [[nodiscard]] std::uint64_t end() const { return data_at + data_size; }
};

/// The record that begins at a place; its data are not looked at and may go beyond the end of the source. Throws
/// Damage.
Ros1Record ros1_record(ByteSource& source, std::uint64_t at);

/// A field of a record's header; empty without one of that name.
std::optional<std::string_view> ros1_field(std::string_view header, std::string_view name);

/// A number of a record's header; throws Damage where it is missing or has another size.
template <class Number>
Number ros1_number(const ByteSource& source, const Ros1Record& record, std::string_view name) {
  const std::optional<std::string_view> field = ros1_field(record.header, name);
  if (!field || field->size() != sizeof(Number)) {
    throw source.damage(record.at, "a record without the field '" + std::string(name) + "'");
  }
  Number value{};
  std::memcpy(&value, field->data(), sizeof(Number));
  return value;
}

/// Times are four bytes of seconds and four of nanoseconds.
constexpr std::int64_t ros1_time(std::uint64_t bytes) {
  return static_cast<std::int64_t>(bytes & 0xFFFFFFFFU) * 1'000'000'000 + static_cast<std::int64_t>(bytes >> 32U);
}

/// What a connection record says. Throws Damage.
Topic ros1_topic(ByteSource& source, const Ros1Record& connection);

}  // namespace dynamic_icp::bags
