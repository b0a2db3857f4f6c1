// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/content_checksum.hpp"

#include <array>

#include "dynamic_icp/method/base/error.hpp"

#include "testing/temporary_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

class ContentChecksumTest : public FolderTest {
 protected:
  void SetUp() override {
    FolderTest::SetUp();
    for (const char* name : {"1.bin", "2.bin", "3.bin"}) {
      write_file(data() / "scans" / name, big_);
    }
    write_file(data() / "poses.txt", "1 2 3");
    before_ = content_checksum(data());
  }

  [[nodiscard]] fs::path data() const { return folder_ / "data"; }

  const std::string big_ = std::string((1U << 20U) + 5, 'x');
  std::string before_;
};

TEST_F(ContentChecksumTest, SizesAreThoseOfTheSameFiles) {
  EXPECT_EQ(content_bytes(data()), 3 * big_.size() + 5);
  EXPECT_EQ(content_bytes(data() / "poses.txt"), 5u);
  write_file(data() / "picture.png", "many pixels");
  write_file(data() / ".hidden", "notes");
  EXPECT_EQ(content_bytes(data()), 3 * big_.size() + 5);
  EXPECT_EQ(content_bytes(data(), data() / "scans"), 5u);
  EXPECT_EQ(content_bytes(data() / "nowhere"), 0u);
}

TEST_F(ContentChecksumTest, IsThatOfNamesAndContents) {
  EXPECT_EQ(content_checksum(data()), before_);
  write_file(data() / "poses.txt", "1 2 4");
  EXPECT_NE(content_checksum(data()), before_) << "a small file of the same size";
  write_file(data() / "poses.txt", "1 2 3");
  EXPECT_EQ(content_checksum(data()), before_) << "written again, but the same";
  write_file(data() / "scans" / "2.bin", big_ + "x");
  EXPECT_NE(content_checksum(data()), before_) << "a large file of another size";
  write_file(data() / "scans" / "2.bin", big_);
  fs::rename(data() / "poses.txt", data() / "ref_poses.txt");
  EXPECT_NE(content_checksum(data()), before_) << "another name";
}

TEST_F(ContentChecksumTest, EveryByteOfEveryFileCounts) {
  for (const std::size_t at : {std::size_t{0}, big_.size() / 2, (std::size_t{1} << 20U) - 1, big_.size() - 1}) {
    std::string changed = big_;
    changed[at] = 'y';
    write_file(data() / "scans" / "2.bin", changed);
    EXPECT_NE(content_checksum(data()), before_) << "byte " << at << " of a file in the middle, of the same size";
  }
}

TEST_F(ContentChecksumTest, SignsOfManyNumbersDoNotCancelOut) {
  Checksum plain;
  plain.add(std::array{1.0, 2.0, 3.0, 4.0});
  Checksum turned;
  turned.add(std::array{1.0, -2.0, -3.0, 4.0});
  EXPECT_NE(plain.text(), turned.text());
}

TEST_F(ContentChecksumTest, HiddenFilesPicturesAndTheOutputAreLeftOut) {
  write_file(data() / "bench" / "results.json", "{}");
  write_file(data() / ".hidden", "x");
  write_file(data() / "camera" / "0.png", "x");
  EXPECT_EQ(content_checksum(data(), data() / "bench"), before_);
  EXPECT_NE(content_checksum(data()), before_) << "anything else counts";
}

TEST_F(ContentChecksumTest, LinksToFoldersAreFollowedAndMayLeadInCircles) {
  fs::create_directories(folder_ / "elsewhere");
  fs::rename(data() / "scans", folder_ / "elsewhere" / "scans");
  fs::create_directory_symlink(folder_ / "elsewhere" / "scans", data() / "scans");
  fs::create_directory_symlink(data(), data() / "scans" / "again");
  EXPECT_EQ(content_checksum(data()), before_) << "as a reader sees it";
  write_file(folder_ / "elsewhere" / "scans" / "2.bin", "other");
  EXPECT_NE(content_checksum(data()), before_);
}

TEST_F(ContentChecksumTest, OfAFileIsThatOfItsContent) {
  const std::string scan = content_checksum(data() / "poses.txt");
  write_file(data() / "poses.txt", "1 2 4");
  EXPECT_NE(content_checksum(data() / "poses.txt"), scan);
  EXPECT_THROW(file_checksum(data() / "missing"), DataError);
}

}  // namespace
}  // namespace dynamic_icp::benchmark
