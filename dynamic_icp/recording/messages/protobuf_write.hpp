// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace dynamic_icp::messages {

/// The bytes of one protobuf message, field by field. As in proto3, a number or text that is the default (0, false,
/// empty) takes no bytes; -0.0 and NaN do. `add_repeated_...` and submessages always do.
class ProtobufWriter {
 public:
  void add_varint(std::uint32_t field, std::uint64_t value);          ///< uint32, uint64, bool, enum
  void add_present_varint(std::uint32_t field, std::uint64_t value);  ///< the same, also where it is 0
  void add_int(std::uint32_t field, std::int64_t value) { add_varint(field, static_cast<std::uint64_t>(value)); }
  void add_fixed32(std::uint32_t field, std::uint32_t value);
  void add_double(std::uint32_t field, double value);
  void add_bytes(std::uint32_t field, std::string_view bytes);  ///< bytes or string
  void add_repeated_bytes(std::uint32_t field, std::string_view bytes);
  void add_message(std::uint32_t field, const ProtobufWriter& message) { add_repeated_bytes(field, message.bytes_); }
  /// Numbers of a repeated field, packed; nothing for none.
  void add_doubles(std::uint32_t field, const double* values, std::size_t count);

  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  void append_varint(std::uint64_t value);
  void append_key(std::uint32_t field, std::uint32_t wire_type) { append_varint((field << 3U) | wire_type); }

  std::string bytes_;
};

}  // namespace dynamic_icp::messages
