// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/ros1_records.hpp"

#include <fmt/format.h>

namespace dynamic_icp::bags {
namespace {

constexpr std::uint32_t kMaxRos1HeaderBytes = 1U << 20U;
constexpr std::uint64_t kMaxRos1ConnectionBytes = std::uint64_t{1} << 26U;

/// Whether bytes are fields, each "name=value" behind its length.
bool are_fields(std::string_view header) {
  while (!header.empty()) {
    std::uint32_t size = 0;
    if (header.size() < sizeof size) {
      return false;
    }
    std::memcpy(&size, header.data(), sizeof size);
    header.remove_prefix(sizeof size);
    if (size > header.size() || header.substr(0, size).find('=') == std::string_view::npos) {
      return false;
    }
    header.remove_prefix(size);
  }
  return true;
}

}  // namespace

std::optional<std::string_view> ros1_field(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    std::uint32_t size = 0;
    std::memcpy(&size, header.data(), sizeof size);
    const std::string_view field = header.substr(sizeof size, size);
    if (field.starts_with(name) && field.substr(name.size()).starts_with('=')) {
      return field.substr(name.size() + 1);
    }
    header.remove_prefix(sizeof size + size);
  }
  return std::nullopt;
}

Ros1Record ros1_record(ByteSource& source, std::uint64_t at) {
  Ros1Record record;
  record.at = at;
  std::uint32_t size = 0;
  std::memcpy(&size, source.bytes(at, sizeof size).data(), sizeof size);
  if (size > kMaxRos1HeaderBytes) {
    throw source.damage(at, fmt::format("a header of {} bytes cannot be", size));
  }
  record.header = source.bytes(at + sizeof size, size);
  std::uint32_t data_size = 0;
  record.data_at = at + sizeof size + size + sizeof data_size;
  std::memcpy(&data_size, source.bytes(record.data_at - sizeof data_size, sizeof data_size).data(), sizeof data_size);
  record.data_size = data_size;
  if (!are_fields(record.header)) {
    throw source.damage(at, "expected a record of a ROS 1 bag");
  }
  const std::optional<std::string_view> op = ros1_field(record.header, "op");
  if (!op || op->size() != 1) {
    throw source.damage(at, "a record that does not say what it is");
  }
  record.op = static_cast<Ros1Op>(op->front());
  return record;
}

Topic ros1_topic(ByteSource& source, const Ros1Record& connection) {
  if (connection.data_size > kMaxRos1ConnectionBytes) {
    throw source.damage(connection.at, fmt::format("a connection of {} bytes cannot be", connection.data_size));
  }
  const std::string_view data = source.bytes(connection.data_at, connection.data_size);
  const auto name = ros1_field(connection.header, "topic");
  if (!name || !are_fields(data)) {
    throw source.damage(connection.at, "a connection without topic or type");
  }
  const auto type = ros1_field(data, "type");
  if (!type) {
    throw source.damage(connection.at, "a connection without topic or type");
  }
  Topic topic;
  topic.name = *name;
  topic.type = *type;
  topic.encoding = Encoding::kRos1;
  topic.encoding_name = "ros1";
  topic.schema = ros1_field(data, "message_definition").value_or("");
  return topic;
}

}  // namespace dynamic_icp::bags
