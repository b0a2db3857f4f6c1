// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/messages/wire_cursor.hpp"

#include <array>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::messages {
namespace {

constexpr std::size_t kEncapsulationBytes = 4;
constexpr std::size_t kMaxPadding = 7;  // what some middleware adds behind the last member

/// A representation identifier of RTPS and of DDS-XTypes, whose two tables differ for XCDR2.
struct Representation {
  std::uint8_t id;
  std::string_view name;
  std::size_t largest_alignment;  ///< 0: not read
  bool is_big_endian;
};

constexpr std::array<Representation, 17> kRepresentations = {{{0x00, "CDR_BE", 8, true},
                                                              {0x01, "CDR_LE", 8, false},
                                                              {0x02, "PL_CDR_BE", 0, true},
                                                              {0x03, "PL_CDR_LE", 0, false},
                                                              {0x04, "XML", 0, false},
                                                              {0x06, "CDR2_BE", 4, true},
                                                              {0x07, "CDR2_LE", 4, false},
                                                              {0x08, "D_CDR2_BE", 0, true},
                                                              {0x09, "D_CDR2_LE", 0, false},
                                                              {0x0A, "PL_CDR2_BE", 0, true},
                                                              {0x0B, "PL_CDR2_LE", 0, false},
                                                              {0x10, "CDR2_BE", 4, true},
                                                              {0x11, "CDR2_LE", 4, false},
                                                              {0x12, "PL_CDR2_BE", 0, true},
                                                              {0x13, "PL_CDR2_LE", 0, false},
                                                              {0x14, "D_CDR2_BE", 0, true},
                                                              {0x15, "D_CDR2_LE", 0, false}}};

}  // namespace

WireCursor WireCursor::ros1(std::string_view bytes, std::string_view origin) { return {bytes, origin, 1, false}; }

WireCursor WireCursor::cdr(std::string_view bytes, std::string_view origin) {
  if (bytes.size() < kEncapsulationBytes) {
    throw DataError(fmt::format("{}: {} bytes, expected CDR, which begins with {} that say the byte order", origin,
                                bytes.size(), kEncapsulationBytes));
  }
  const auto first = static_cast<std::uint8_t>(bytes[0]);
  const auto id = static_cast<std::uint8_t>(bytes[1]);
  const auto* const known = std::find_if(kRepresentations.begin(), kRepresentations.end(),
                                         [&](const Representation& r) { return first == 0 && r.id == id; });
  if (known == kRepresentations.end() || known->largest_alignment == 0) {
    throw DataError(
        fmt::format("{}: begins with the bytes {:02X} {:02X}{}, expected plain CDR (00 00, 00 01, 00 06 or "
                    "00 07)",
                    origin, first, id, known == kRepresentations.end() ? "" : fmt::format(" of {}", known->name)));
  }
  return {bytes.substr(kEncapsulationBytes), origin, known->largest_alignment, known->is_big_endian};
}

void WireCursor::align(std::size_t size, std::string_view field) {
  const std::size_t alignment = std::min(size, largest_alignment_);
  take((alignment - at_ % alignment) % alignment, field);
}

std::string_view WireCursor::take(std::size_t size, std::string_view field) {
  if (size > bytes_.size() - at_) {
    throw DataError(
        fmt::format("{}: {} takes {} bytes at byte {}, {} are left", origin_, field, size, at_, bytes_.size() - at_));
  }
  at_ += size;
  return bytes_.substr(at_ - size, size);
}

std::string_view WireCursor::text(std::string_view field) {
  const auto size = number<std::uint32_t>(field);
  std::string_view text = take(size, field);
  if (!is_ros1() && text.ends_with('\0')) {
    text.remove_suffix(1);
  }
  return text;
}

std::string_view WireCursor::bytes(std::string_view field) { return take(number<std::uint32_t>(field), field); }

std::size_t WireCursor::count(std::size_t least_bytes, std::string_view field) {
  const auto items = number<std::uint32_t>(field);
  if (items > (bytes_.size() - at_) / least_bytes) {
    throw DataError(
        fmt::format("{}: {} {} at byte {}, but {} bytes are left", origin_, items, field, at_, bytes_.size() - at_));
  }
  return items;
}

Eigen::Vector3d WireCursor::vector(std::string_view field) {
  const auto x = number<double>(field);
  const auto y = number<double>(field);
  const auto z = number<double>(field);
  return {x, y, z};
}

Eigen::Quaterniond WireCursor::quaternion(std::string_view field) {
  const Eigen::Vector3d xyz = vector(field);
  const auto w = number<double>(field);
  return {w, xyz.x(), xyz.y(), xyz.z()};
}

void WireCursor::skip_doubles(std::size_t numbers, std::string_view field) {
  for (std::size_t k = 0; k < numbers; ++k) {
    number<double>(field);
  }
}

void WireCursor::finish() const {
  const std::size_t left = bytes_.size() - at_;
  if (left > (is_ros1() ? 0 : kMaxPadding)) {
    throw DataError(
        fmt::format("{}: {} bytes are left behind its last field, at byte {}: the message is of another "
                    "definition",
                    origin_, left, at_));
  }
}

}  // namespace dynamic_icp::messages
