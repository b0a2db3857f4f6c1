// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/protobuf_cursor.hpp"

#include <bit>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::messages {
namespace {

constexpr unsigned kVarint = 0;
constexpr unsigned kFixed64 = 1;
constexpr unsigned kLengthDelimited = 2;
constexpr unsigned kFixed32 = 5;

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t k = bytes.size(); k-- > 0;) {
    value = value << 8U | static_cast<unsigned char>(bytes[k]);
  }
  return value;
}

}  // namespace

void ProtobufCursor::fail(std::string_view what) const {
  throw DataError(
      fmt::format("{}: field {} of a protobuf message, before its byte {}: {}", origin_, number_, at_, what));
}

void ProtobufCursor::expect(unsigned type, std::string_view expected) const {
  if (type_ != type) {
    fail(fmt::format("is of wire type {}, expected {} ({})", type_, type, expected));
  }
}

std::uint64_t ProtobufCursor::take_varint() {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = static_cast<unsigned char>(take(1).front());
    value |= std::uint64_t{byte & 0x7FU} << shift;
    if ((byte & 0x80U) == 0) {
      return value;
    }
  }
  fail("a number of more than ten bytes");
}

std::string_view ProtobufCursor::take(std::uint64_t size) {
  if (size > bytes_.size() - at_) {
    fail(fmt::format("takes {} bytes, {} are left", size, bytes_.size() - at_));
  }
  at_ += static_cast<std::size_t>(size);
  return bytes_.substr(at_ - static_cast<std::size_t>(size), static_cast<std::size_t>(size));
}

bool ProtobufCursor::next() {
  if (at_ == bytes_.size()) {
    return false;
  }
  const std::uint64_t key = take_varint();
  number_ = key >> 3U;
  type_ = static_cast<unsigned>(key & 7U);
  switch (type_) {
    case kVarint:
      varint_ = take_varint();
      return true;
    case kFixed64:
      value_ = take(sizeof(std::uint64_t));
      return true;
    case kLengthDelimited:
      value_ = take(take_varint());
      return true;
    case kFixed32:
      value_ = take(sizeof(std::uint32_t));
      return true;
    default:
      fail(fmt::format("is of wire type {}, expected 0, 1, 2 or 5", type_));
  }
}

std::uint64_t ProtobufCursor::varint() const {
  expect(kVarint, "a number");
  return varint_;
}

std::uint32_t ProtobufCursor::fixed32() const {
  expect(kFixed32, "four bytes");
  return static_cast<std::uint32_t>(little_endian(value_));
}

double ProtobufCursor::fixed64() const {
  expect(kFixed64, "eight bytes");
  return std::bit_cast<double>(little_endian(value_));
}

std::string_view ProtobufCursor::bytes() const {
  expect(kLengthDelimited, "bytes behind their number");
  return value_;
}

}  // namespace dynamic_icp::messages
