// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/lzf.hpp"

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {
namespace {

using namespace std::string_literals;

std::string message(const std::string& packed, std::size_t bytes) {
  try {
    unpack_lzf(packed, bytes, "scan.pcd");
  } catch (const DataError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Lzf, UnpacksWhatStandsForItself) {
  EXPECT_EQ(unpack_lzf("\x02"s + "abc", 3, ""), "abc");
  EXPECT_EQ(unpack_lzf("\x1f"s + std::string(32, 'q') + "\x00z"s, 33, ""), std::string(32, 'q') + "z");
  EXPECT_EQ(unpack_lzf("", 0, ""), "");
}

TEST(Lzf, RepeatsWhatWasBefore) {
  // "abc", then 3 bytes (length field 1) from 3 bytes back (offset field 2).
  EXPECT_EQ(unpack_lzf("\x02"s + "abc" + "\x20\x02", 6, ""), "abcabc");
  // 8 bytes (length field 6) from 1 byte back, reaching into what is being written.
  EXPECT_EQ(unpack_lzf("\x00"s + "a" + "\xc0\x00"s, 9, ""), "aaaaaaaaa");
  // The long form: 7 + 250 + 2 bytes from 2 bytes back.
  std::string expected = "ab";
  for (int i = 0; i < 259; ++i) {
    expected.push_back(i % 2 == 0 ? 'a' : 'b');
  }
  EXPECT_EQ(unpack_lzf("\x01"s + "ab" + "\xe0\xfa\x01", expected.size(), ""), expected);
}

TEST(Lzf, ReachesFarBack) {
  // 300 bytes that differ, then 3 from 300 back: the offset field is 299 = 1 * 256 + 43.
  std::string packed;
  std::string expected;
  for (int i = 0; i < 300; ++i) {
    packed += "\x00"s + static_cast<char>(i % 251);
    expected.push_back(static_cast<char>(i % 251));
  }
  packed += "\x21\x2b";
  expected += expected.substr(0, 3);
  EXPECT_EQ(unpack_lzf(packed, 303, ""), expected);
}

TEST(Lzf, DamageIsNamedByFileAndByte) {
  EXPECT_NE(message("\x05"s + "ab", 6).find("scan.pcd: byte 1 of the compressed data: the stream ends"),
            std::string::npos)
      << message("\x05"s + "ab", 6);
  EXPECT_NE(message("\x20", 3).find("ends within"), std::string::npos);
  EXPECT_NE(message("\xe0\x01", 10).find("ends within"), std::string::npos);
  EXPECT_NE(message("\x20\x00"s, 3).find("repeats from 1 bytes back"), std::string::npos);
  EXPECT_NE(message("\x00"s + "a" + "\x20\x01", 4).find("repeats from 2 bytes back"), std::string::npos);
  EXPECT_NE(message("\x02"s + "abc", 2).find("unpacks to more than 2"), std::string::npos);
  EXPECT_NE(message("\x00"s + "a" + "\x20\x00"s, 2).find("unpacks to more than 2"), std::string::npos);
  EXPECT_NE(message("\x02"s + "abc", 4).find("expected 4"), std::string::npos);
}

TEST(Lzf, TakesNoMemoryForWhatCannotBeThere) {
  EXPECT_NE(message("\x00"s + "a", std::size_t{1} << 60U).find("cannot hold"), std::string::npos);
}

}  // namespace
}  // namespace dynamic_icp::formats
