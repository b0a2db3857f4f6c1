// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/compression.hpp"

#include <string>

#include <gtest/gtest.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/crc32.hpp"

#include "testing/bags_by_hand.hpp"
#include "testing/temporary_folder.hpp"

namespace dynamic_icp::bags {
namespace {

struct Packing {
  const char* name;
  Compression compression;
};

constexpr Packing kPackings[] = {
    {"none", Compression::kNone}, {"bz2", Compression::kBz2}, {"lz4", Compression::kLz4}, {"zstd", Compression::kZstd}};

/// Does not pack well.
std::string noise(std::size_t size) {
  std::string bytes(size, '\0');
  std::uint32_t random = 1;
  for (char& byte : bytes) {
    random = random * 1664525U + 1013904223U;
    byte = static_cast<char>(random >> 24U);
  }
  return bytes;
}

TEST(Compression, HasTheNamesOfBags) {
  for (const Packing& packing : kPackings) {
    EXPECT_EQ(compression_of(packing.name), packing.compression);
  }
  EXPECT_EQ(compression_of(""), Compression::kNone);
  EXPECT_FALSE(compression_of("gzip").has_value());
}

TEST(Compression, UnpacksWhatWasPacked) {
  for (const Packing& packing : kPackings) {
    for (const std::string& content : {std::string(), std::string("a"), std::string(3'000'000, 'x'), noise(200'000)}) {
      const std::string packed = by_hand::packed(packing.name, content);
      const Unpacked unpacked = unpack(packing.compression, packed, content.size());
      EXPECT_EQ(unpacked.fault, "") << packing.name << ' ' << content.size();
      EXPECT_EQ(unpacked.bytes, content) << packing.name;
    }
  }
}

TEST(Compression, UnpacksFramesThatFollowEachOther) {
  for (const char* const name : {"bz2", "lz4", "zstd"}) {
    const std::string packed = by_hand::packed(name, "first ") + by_hand::packed(name, "second");
    const Unpacked unpacked = unpack(*compression_of(name), packed, 12);
    EXPECT_EQ(unpacked.fault, "") << name;
    EXPECT_EQ(unpacked.bytes, "first second") << name;
  }
}

TEST(Compression, RefusesAnyOtherSizeThanTheStatedOne) {
  const std::string content = noise(100'000);
  for (const Packing& packing : kPackings) {
    const std::string packed = by_hand::packed(packing.name, content);
    EXPECT_NE(unpack(packing.compression, packed, content.size() + 1).fault, "") << packing.name;
    EXPECT_NE(unpack(packing.compression, packed, content.size() - 1).fault, "") << packing.name;
    EXPECT_NE(unpack(packing.compression, packed, 0).fault, "") << packing.name;
    // A length out of a damaged file is not allocated.
    EXPECT_NE(unpack(packing.compression, packed, std::uint64_t{1} << 60U).fault, "") << packing.name;
    const Unpacked little = unpack(packing.compression, packed, 10);
    EXPECT_LE(little.bytes.size(), 10U) << packing.name;
  }
}

TEST(Compression, GivesWhatComesBeforeACut) {
  const std::string content = noise(2'000'000);
  for (const Packing& packing : kPackings) {
    const std::string packed = by_hand::packed(packing.name, content);
    const Unpacked cut =
        unpack(packing.compression, std::string_view(packed).substr(0, packed.size() / 2), content.size());
    EXPECT_TRUE(cut.is_cut) << packing.name;
    EXPECT_NE(cut.fault, "") << packing.name;
    EXPECT_GT(cut.bytes.size(), content.size() / 4) << packing.name;
    EXPECT_EQ(cut.bytes, content.substr(0, cut.bytes.size())) << packing.name;
  }
}

TEST(Compression, SeesDamage) {
  for (const char* const name : {"bz2", "lz4", "zstd"}) {
    std::string packed = by_hand::packed(name, noise(1000));
    packed[0] = static_cast<char>(packed[0] ^ 0x55);
    const Unpacked damaged = unpack(*compression_of(name), packed, 1000);
    EXPECT_NE(damaged.fault, "") << name;
    EXPECT_FALSE(damaged.is_cut) << name;
  }
}

TEST(Compression, OfMessagesHasABound) {
  const std::string packed = by_hand::packed("zstd", std::string(100'000, 'x'));
  EXPECT_EQ(unpack_zstd(packed, 100'000).bytes.size(), 100'000U);
  EXPECT_EQ(unpack_zstd(packed, 100'000).fault, "");
  EXPECT_NE(unpack_zstd(packed, 99'999).fault, "");
  EXPECT_NE(unpack_zstd("no Zstandard", 100).fault, "");
}

class PackedFile : public benchmark::FolderTest {};

TEST_F(PackedFile, IsUnpackedIntoAnother) {
  const std::string content = noise(500'000) + std::string(5'000'000, 'x');
  const std::string packed = by_hand::packed("zstd", content);
  const auto read = [&](const std::string& name) {
    std::ifstream file(folder_ / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  write_file(folder_ / "whole", packed);
  EXPECT_EQ(unpack_zstd_file(folder_ / "whole", folder_ / "whole.out"), "");
  EXPECT_EQ(read("whole.out"), content);
  EXPECT_EQ(zstd_file_head(folder_ / "whole", 100), content.substr(0, 100));
  write_file(folder_ / "cut", packed.substr(0, packed.size() / 2));
  EXPECT_NE(unpack_zstd_file(folder_ / "cut", folder_ / "cut.out").find("cut short at byte"), std::string::npos);
  const std::string begin = read("cut.out");
  EXPECT_GT(begin.size(), 100'000U);
  EXPECT_EQ(begin, content.substr(0, begin.size()));
  EXPECT_THROW(unpack_zstd_file(folder_ / "whole", folder_ / "no" / "out"), DataError);
  EXPECT_THROW(unpack_zstd_file(folder_ / "whole", folder_ / "whole.out"), DataError) << "there is one";
  EXPECT_THROW(unpack_zstd_file(folder_ / "missing", folder_ / "out"), DataError);
}

TEST(Crc32, IsThatOfZipArchives) {
  EXPECT_EQ(crc32("123456789"), 0xCBF43926U) << "the check value of the catalogue of CRC algorithms";
  const std::string bytes = noise(1000);
  for (std::size_t size = 0; size < 40; ++size) {
    EXPECT_EQ(crc32(std::string_view(bytes).substr(size, 3 * size)), formats::crc32_of(bytes.substr(size, 3 * size)));
  }
  EXPECT_EQ(crc32(std::string_view(bytes).substr(333), crc32(std::string_view(bytes).substr(0, 333))), crc32(bytes));
}

}  // namespace
}  // namespace dynamic_icp::bags
