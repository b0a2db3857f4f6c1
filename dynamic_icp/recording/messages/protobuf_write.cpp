// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/protobuf_write.hpp"

#include <bit>

#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::messages {
namespace {

// The wire types of the specification that are written.
constexpr std::uint32_t kWriteVarint = 0;
constexpr std::uint32_t kWriteFixed64 = 1;
constexpr std::uint32_t kWriteLengthDelimited = 2;
constexpr std::uint32_t kWriteFixed32 = 5;

}  // namespace

void ProtobufWriter::append_varint(std::uint64_t value) {
  while (value >= 0x80U) {
    bytes_ += static_cast<char>((value & 0x7FU) | 0x80U);
    value >>= 7U;
  }
  bytes_ += static_cast<char>(value);
}

void ProtobufWriter::add_varint(std::uint32_t field, std::uint64_t value) {
  if (value != 0) {
    add_present_varint(field, value);
  }
}

void ProtobufWriter::add_present_varint(std::uint32_t field, std::uint64_t value) {
  append_key(field, kWriteVarint);
  append_varint(value);
}

void ProtobufWriter::add_fixed32(std::uint32_t field, std::uint32_t value) {
  if (value != 0) {
    append_key(field, kWriteFixed32);
    formats::append_value(bytes_, value);
  }
}

void ProtobufWriter::add_double(std::uint32_t field, double value) {
  if (std::bit_cast<std::uint64_t>(value) != 0) {
    append_key(field, kWriteFixed64);
    formats::append_value(bytes_, value);
  }
}

void ProtobufWriter::add_bytes(std::uint32_t field, std::string_view bytes) {
  if (!bytes.empty()) {
    add_repeated_bytes(field, bytes);
  }
}

void ProtobufWriter::add_repeated_bytes(std::uint32_t field, std::string_view bytes) {
  append_key(field, kWriteLengthDelimited);
  append_varint(bytes.size());
  bytes_ += bytes;
}

void ProtobufWriter::add_doubles(std::uint32_t field, const double* values, std::size_t count) {
  if (count == 0) {
    return;
  }
  append_key(field, kWriteLengthDelimited);
  append_varint(count * sizeof(double));
  for (std::size_t k = 0; k < count; ++k) {
    formats::append_value(bytes_, values[k]);
  }
}

}  // namespace dynamic_icp::messages
