// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npz.hpp"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <ctime>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

#include "testing/npz_by_hand.hpp"

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

// What numpy.savez_compressed of NumPy 1.24 writes for
//   xyz = [[1.5, -2, 0.25], [4, 5, 6]] float32, semantic_labels = [["road"], ["car"]] objects,
//   velocity = [[-3.25], [0.5]] float64, big-endian, semantic_labels_idx = [[19], [1]] int64.
constexpr std::string_view kFromNumpy =
    "504b030414000000080000002100741cc4505a000000980000000700140078797a2e6e70790100100098000000000000005a000000000000"
    "009bec17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9366a2aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402"
    "f91a463a0ac69a3a0ab50a64032e068603f60c408281a1c10e881d18181600f1010700504b0304140000000800000021005e6344e2df0000"
    "00310100001300140073656d616e7469635f6c6162656c732e6e7079010010003101000000000000df000000000000009d8acf4a033118c4"
    "93dd6a35fe7d84dcb2c2b2a027f1e241f060705b0ac2f6504a368928b49bfdbecd0a8b15bcd4dab30facd1fa049dc330f39bf9ca1fee8763"
    "4a5ec8ab30b6d128aeb8580c44cac5a3438faa9a3a34f617dfaa5963036f9e546d434f2e527e7e96f237bebdd87bacab765e77997668b379"
    "3bf3cf0a51756c8a56bbaaf1d86acf806c5eac329b15a8244b886e6809f10a7a23d849249591a41fb0fb7f35beab2d837e1111420697b0b7"
    "fe5cc1fe085822e38206b680833ccfefbe83fe4c5e7b382cd713384a8a5ed8d12903c7451ca2560827d6c36999fd00504b03041400000008"
    "00000021000f94cec64f000000900000000c00140076656c6f636974792e6e70790100100090000000000000004f000000000000009bec17"
    "ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9766a1aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402f91a463a"
    "0a869a3a0ab50a6403ae035c0c6060ff00420300504b030414000000080000002100ea7588174c000000900000001700140073656d616e74"
    "69635f6c6162656c735f6964782e6e70790100100090000000000000004c000000000000009bec17ea1b10c9c850c650ad9e925a9c5ca46e"
    "a5a06e9369a1aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402f91a463a0a869a3a0ab50a64032e6106086084d2"
    "00504b0102140314000000080000002100741cc4505a0000009800000007000000000000000000000080010000000078797a2e6e7079504b"
    "01021403140000000800000021005e6344e2df0000003101000013000000000000000000000080019300000073656d616e7469635f6c6162"
    "656c732e6e7079504b01021403140000000800000021000f94cec64f000000900000000c00000000000000000000008001b701000076656c"
    "6f636974792e6e7079504b0102140314000000080000002100ea7588174c0000009000000017000000000000000000000080014402000073"
    "656d616e7469635f6c6162656c735f6964782e6e7079504b05060000000004000400f5000000d90200000000";

std::string from_hex(std::string_view digits) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(digits.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

template <class Number>
void overwrite(std::string& bytes, std::size_t offset, Number value) {
  bytes.replace(offset, sizeof(Number), reinterpret_cast<const char*>(&value), sizeof(Number));
}

std::vector<NpzMember> two_members() {
  return {{"xyz", npy_array<float>({1, 3}, std::array{1.0F, 2.0F, -3.25F})},
          {"line_index", npy_array<std::uint32_t>({2}, std::array<std::uint32_t, 2>{7, 8})}};
}

class Npz : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& content) const {
    fs::remove(path_);  // quicker than to write over it
    write_bytes(path_, std::as_bytes(std::span(content)));
  }

  /// The message of the DataError that opening an archive of these bytes and reading one array throws.
  std::string fault(const std::string& content, const std::string& name) {
    write(content);
    return fault_at(path_, name);
  }
  static std::string fault_at(const fs::path& path, const std::string& name) {
    try {
      (void)NpzFile(path).read(name);
    } catch (const DataError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path.string() + ": ")) << error.what();
      return error.what();
    }
    return "no error";
  }

  const std::string from_numpy_ = from_hex(kFromNumpy);
  fs::path folder_ = fs::temp_directory_path() / ("npz_test-" + std::to_string(::getpid()));
  fs::path path_ = folder_ / "a.npz";
};

TEST_F(Npz, ReadsWhatNumpyWrites) {
  write(from_numpy_);
  const NpzFile file(path_);
  EXPECT_EQ(file.names(), (std::vector<std::string>{"xyz", "semantic_labels", "velocity", "semantic_labels_idx"}));
  EXPECT_TRUE(file.contains("velocity"));
  EXPECT_FALSE(file.contains("velocity.npy") || file.contains("reflectivity"));
  const NpyArray xyz = file.read("xyz");
  EXPECT_EQ(xyz.shape, (std::vector<std::size_t>{2, 3}));
  EXPECT_EQ(column_as_doubles(xyz, 0), (std::vector<double>{1.5, 4.0}));
  EXPECT_EQ(column_as_doubles(xyz, 2), (std::vector<double>{0.25, 6.0}));
  EXPECT_EQ(column_as_doubles(file.read("velocity")), (std::vector<double>{-3.25, 0.5}));
}

TEST_F(Npz, ObjectArraysDoNotDisturbTheOthers) {
  EXPECT_NE(fault(from_numpy_, "semantic_labels").find("array 'semantic_labels': holds Python objects"),
            std::string::npos);
  const NpzFile file(path_);
  EXPECT_THROW((void)file.read("semantic_labels"), DataError);
  EXPECT_EQ(file.why_no_numbers("semantic_labels"),
            "array 'semantic_labels': holds Python objects, expected an array of numbers");
  EXPECT_FALSE(file.why_no_numbers("no such member").empty());
  EXPECT_EQ(file.why_no_numbers("xyz"), "");
  EXPECT_EQ(column_as_integers(file.read("semantic_labels_idx")), (std::vector<std::int64_t>{19, 1}));
}

TEST_F(Npz, AMissingArrayIsNamedWithThoseThatAreThere) {
  EXPECT_NE(fault(from_numpy_, "doppler").find("array 'doppler': is missing, expected it among: xyz semantic_labels"),
            std::string::npos);
}

TEST_F(Npz, WhatIsNoArchiveIsRefused) {
  EXPECT_NE(fault("", "xyz"), "no error");
  EXPECT_NE(fault("\x93NUMPY and so on", "xyz").find("is an array of NumPy"), std::string::npos);
  EXPECT_NE(fault("version https://git-lfs.github.com/spec/v1\n", "xyz").find("Git LFS pointer"), std::string::npos);
  EXPECT_NE(fault_at(folder_ / "missing.npz", "xyz").find("No such file"), std::string::npos);
  EXPECT_NE(fault_at(folder_, "xyz"), "no error");
}

TEST_F(Npz, ShortenedArchivesAreRefused) {
  for (std::size_t size = 0; size < from_numpy_.size(); size += 11) {
    EXPECT_NE(fault(from_numpy_.substr(0, size), "xyz"), "no error") << size;
  }
}

TEST_F(Npz, AFlippedBitIsNoticedOrDoesNoHarm) {
  write(from_numpy_);
  const std::string xyz = NpzFile(path_).read("xyz").bytes;
  for (std::size_t i = 0; i < from_numpy_.size(); i += 3) {
    std::string damaged = from_numpy_;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
    write(damaged);
    try {
      EXPECT_EQ(NpzFile(path_).read("xyz").bytes, xyz) << "byte " << i;
    } catch (const DataError&) {
      continue;
    }
  }
}

TEST_F(Npz, ClaimsAboutSizesAreNotBelieved) {
  const std::size_t xyz = central_entries(from_numpy_).at(0);
  std::string damaged = from_numpy_;
  overwrite<std::uint32_t>(damaged, xyz + 24, 0xFFFFFFF0U);
  EXPECT_NE(fault(damaged, "xyz").find("array 'xyz': claims 4294967280 bytes, expected at most 268435456"),
            std::string::npos);
  EXPECT_EQ(fault(damaged, "velocity"), "no error");
  for (const std::uint32_t claim : {151U, 153U, 1U << 28U}) {
    overwrite<std::uint32_t>(damaged, xyz + 24, claim);
    EXPECT_NE(fault(damaged, "xyz").find("is damaged"), std::string::npos) << claim;
  }
  std::string stored = npz_bytes(two_members());
  overwrite<std::uint32_t>(stored, central_entries(stored).at(0) + 24, 1U << 28U);
  overwrite<std::uint32_t>(stored, central_entries(stored).at(0) + 20, 1U << 28U);
  EXPECT_NE(fault(stored, "xyz"), "no error");
}

TEST_F(Npz, WritesStoredMembersInOrder) {
  const std::string archive = npz_bytes(two_members());
  const auto members = stored_members(archive);
  ASSERT_EQ(members.size(), 2U);
  EXPECT_EQ(members[0].first, "xyz.npy");
  EXPECT_EQ(numbers_of<float>(members[0].second, "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 3), }"),
            (std::vector<float>{1.0F, 2.0F, -3.25F}));
  EXPECT_EQ(members[1].first, "line_index.npy");
  EXPECT_EQ(numbers_of<std::uint32_t>(members[1].second, "{'descr': '<u4', 'fortran_order': False, 'shape': (2,), }"),
            (std::vector<std::uint32_t>{7, 8}));
  for (const std::size_t entry : central_entries(archive)) {
    EXPECT_EQ(number_in<std::uint32_t>(archive, entry + 12), 0x00210000U) << "time and date: 1980-01-01 00:00";
  }
}

TEST_F(Npz, SameBytesEachTime) {
  const std::string bytes = npz_bytes(two_members());
  const char* const zone = std::getenv("TZ");
  const std::string before = zone == nullptr ? "" : zone;
  for (const char* other : {"Asia/Seoul", "America/Los_Angeles", "UTC"}) {
    ::setenv("TZ", other, 1);
    ::tzset();
    EXPECT_EQ(npz_bytes(two_members()), bytes) << other;
  }
  zone == nullptr ? ::unsetenv("TZ") : ::setenv("TZ", before.c_str(), 1);
  ::tzset();
}

TEST_F(Npz, WritesWholeFilesThatComeBack) {
  std::vector<double> values(300'000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(i * i % 9973);
  }
  write_npz(path_, std::array{NpzMember{"a", npy_array<double>({values.size()}, values)},
                              NpzMember{"none", npy_array<float>({0, 3}, {})}});
  const NpzFile file(path_);
  EXPECT_EQ(column_as_doubles(file.read("a")), values);
  EXPECT_EQ(rows_of(file.read("none")), 0U);
  try {
    write_npz(folder_ / "missing" / "a.npz", two_members());
    FAIL();
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find((folder_ / "missing" / "a.npz").string()), std::string::npos);
  }
}

TEST_F(Npz, ArchivesThatClaimTooMuchTogetherAreRefused) {
  // Three members, each of which may be that large alone.
  std::vector<NpzMember> members = two_members();
  members.push_back({"more", npy_array<float>({1}, std::array{1.0F})});
  std::string bytes = npz_bytes(members);
  for (const std::size_t at : central_entries(bytes)) {
    overwrite<std::uint32_t>(bytes, at + 24, static_cast<std::uint32_t>(kMaxNpzMemberBytes));
  }
  write_whole_file(path_, bytes);
  try {
    const NpzFile file(path_);
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find(path_.string() + ": its arrays claim more than 536870912 bytes"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Npz, MoreRowsThanAnyScanHasAreRefused) {
  const std::vector<std::uint8_t> values(kMaxNpzRows + 1);
  write_npz(path_, std::array{NpzMember{"a", npy_array<std::uint8_t>({values.size()}, values)},
                              NpzMember{"b", npy_array<std::uint8_t>({1, 3}, std::array<std::uint8_t, 3>{1, 2, 3})}});
  const NpzFile file(path_);
  EXPECT_EQ(rows_of(file.read("b")), 1U);
  try {
    (void)file.read("a");
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("array 'a': has 33554433 rows, expected at most 33554432"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(Npz, ImpossibleArchivesAreNotWritten) {
  EXPECT_THROW(npz_bytes({}), std::invalid_argument);
  std::vector<NpzMember> members = two_members();
  members[1].name = "xyz";
  EXPECT_THROW(npz_bytes(members), std::invalid_argument);
  members[1].name = "";
  EXPECT_THROW(npz_bytes(members), std::invalid_argument);
}

}  // namespace
}  // namespace dynamic_icp::formats
