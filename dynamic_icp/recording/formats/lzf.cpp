// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/lzf.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

// The stream is a sequence of pieces. The first byte of a piece tells what it is:
//   000nnnnn                    n + 1 bytes follow that stand for themselves
//   lllooooo oooooooo           repeat l + 2 bytes from o + 1 bytes back; l is 1 to 6
//   111ooooo llllllll oooooooo  the same with l + 7 for l
namespace dynamic_icp::formats {
namespace {

constexpr std::size_t kLongestRepeat = 255 + 7 + 2;  // in 3 bytes, the best that the compression can do
constexpr unsigned kLongLength = 7;

class Unpacker {
 public:
  Unpacker(std::string_view packed, std::size_t unpacked_bytes, std::string_view origin)
      : packed_(packed), unpacked_bytes_(unpacked_bytes), origin_(origin) {}

  std::string unpack() {
    if (unpacked_bytes_ / kLongestRepeat > packed_.size()) {
      fail(fmt::format("{} compressed bytes cannot hold {}", packed_.size(), unpacked_bytes_));
    }
    unpacked_.reserve(unpacked_bytes_);
    while (at_ < packed_.size()) {
      const unsigned control = next();
      if (control < 32U) {
        copy(control + 1U);
      } else {
        repeat(control);
      }
    }
    if (unpacked_.size() != unpacked_bytes_) {
      fail(fmt::format("the stream ends with {} bytes unpacked, expected {}", unpacked_.size(), unpacked_bytes_));
    }
    return std::move(unpacked_);
  }

 private:
  [[noreturn]] void fail(std::string_view message) const {
    throw DataError(fmt::format("{}: byte {} of the compressed data: {}", origin_, at_, message));
  }

  unsigned next() {
    if (at_ == packed_.size()) {
      fail("the stream ends within a piece");
    }
    return static_cast<unsigned char>(packed_[at_++]);
  }

  void expect_room(std::size_t bytes) const {
    if (bytes > unpacked_bytes_ - unpacked_.size()) {
      fail(fmt::format("unpacks to more than {} bytes", unpacked_bytes_));
    }
  }

  void copy(std::size_t bytes) {
    expect_room(bytes);
    if (bytes > packed_.size() - at_) {
      fail("the stream ends within a piece");
    }
    unpacked_.append(packed_.substr(at_, bytes));
    at_ += bytes;
  }

  void repeat(unsigned control) {
    unsigned length = control >> 5U;
    length += length == kLongLength ? next() : 0U;
    const std::size_t back = ((control & 31U) << 8U) + next() + 1U;
    const std::size_t bytes = length + 2U;
    expect_room(bytes);
    if (back > unpacked_.size()) {
      fail(fmt::format("repeats from {} bytes back, where there are only {}", back, unpacked_.size()));
    }
    // What is repeated may reach into what is being written, so byte by byte.
    for (std::size_t i = 0; i < bytes; ++i) {
      unpacked_.push_back(unpacked_[unpacked_.size() - back]);
    }
  }

  std::string_view packed_;
  std::size_t unpacked_bytes_;
  std::string_view origin_;
  std::size_t at_ = 0;
  std::string unpacked_;
};

}  // namespace

std::string unpack_lzf(std::string_view packed, std::size_t unpacked_bytes, std::string_view origin) {
  return Unpacker(packed, unpacked_bytes, origin).unpack();
}

}  // namespace dynamic_icp::formats
