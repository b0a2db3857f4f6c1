// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace dynamic_icp::messages {

/// Takes numbers and texts, one after the other, from the bytes of a message of ROS 1 or of CDR.
///
/// ROS 1: little-endian, packed. CDR: four bytes say the byte order, and every number lies at a multiple of its own
/// size counted from behind them (of 4 at most in XCDR2); texts end with a NUL. Whatever is read is checked against
/// what is there first. Throws DataError that begins with `origin` and names the field; both texts must outlive the
/// cursor.
class WireCursor {
 public:
  static WireCursor ros1(std::string_view bytes, std::string_view origin);

  /// Throws DataError for representations that are not plain, such as PL_CDR, by their names.
  static WireCursor cdr(std::string_view bytes, std::string_view origin);

  [[nodiscard]] bool is_ros1() const { return largest_alignment_ == 1; }

  template <class Number>
  Number number(std::string_view field) {
    align(sizeof(Number), field);
    const std::string_view bytes = take(sizeof(Number), field);
    char ordered[sizeof(Number)];
    std::memcpy(ordered, bytes.data(), sizeof(Number));
    if (is_big_endian_) {
      std::reverse(ordered, ordered + sizeof(Number));
    }
    Number value{};
    std::memcpy(&value, ordered, sizeof(Number));
    return value;
  }

  /// Without the NUL at its end.
  std::string_view text(std::string_view field);

  /// A sequence of bytes.
  std::string_view bytes(std::string_view field);

  /// The number of items of a sequence, each of which takes `least_bytes` or more: no more than can be there.
  std::size_t count(std::size_t least_bytes, std::string_view field);

  /// Three numbers of 64 bits.
  Eigen::Vector3d vector(std::string_view field);

  /// x, y, z, w; as they are.
  Eigen::Quaterniond quaternion(std::string_view field);

  /// Numbers of 64 bits that are of no use here.
  void skip_doubles(std::size_t numbers, std::string_view field);

  /// Throws DataError when more is left than padding: the definition of the message is another one.
  void finish() const;

 private:
  WireCursor(std::string_view bytes, std::string_view origin, std::size_t largest_alignment, bool is_big_endian)
      : bytes_(bytes), origin_(origin), largest_alignment_(largest_alignment), is_big_endian_(is_big_endian) {}

  void align(std::size_t size, std::string_view field);
  std::string_view take(std::size_t size, std::string_view field);

  std::string_view bytes_;  ///< behind the encapsulation header of CDR
  std::string_view origin_;
  std::size_t largest_alignment_;  ///< 1: packed
  bool is_big_endian_;
  std::size_t at_ = 0;
};

}  // namespace dynamic_icp::messages
