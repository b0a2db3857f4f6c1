// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace dynamic_icp::messages {

/// Walks the fields of a protobuf message in the order of its bytes:
///
///   while (cursor.next()) switch (cursor.number()) { case 2: frame = cursor.bytes(); break; ... }
///
/// Fields of unknown numbers pass. Throws DataError that begins with `origin` where bytes are too few, a wire type is
/// unknown or not the one asked for; both texts must outlive the cursor.
class ProtobufCursor {
 public:
  ProtobufCursor(std::string_view bytes, std::string_view origin) : bytes_(bytes), origin_(origin) {}

  /// Goes to the next field; false at the end.
  bool next();

  /// The number of the field in its message.
  [[nodiscard]] std::uint64_t number() const { return number_; }

  // The value of the field.
  [[nodiscard]] std::uint64_t varint() const;
  [[nodiscard]] std::uint32_t fixed32() const;
  [[nodiscard]] double fixed64() const;
  [[nodiscard]] std::string_view bytes() const;  ///< of a text, bytes or a message

  /// The message that the field holds.
  [[nodiscard]] ProtobufCursor message() const { return {bytes(), origin_}; }

 private:
  [[noreturn]] void fail(std::string_view what) const;
  void expect(unsigned type, std::string_view expected) const;
  std::uint64_t take_varint();
  std::string_view take(std::uint64_t size);

  std::string_view bytes_;
  std::string_view origin_;
  std::size_t at_ = 0;
  std::uint64_t number_ = 0;
  unsigned type_ = 0;
  std::uint64_t varint_ = 0;
  std::string_view value_;
};

}  // namespace dynamic_icp::messages
