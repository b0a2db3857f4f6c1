// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/benchmark/sequences.hpp"

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/benchmark/folder_test.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

class SequencesTest : public FolderTest {
 protected:
  std::vector<std::string> labels(const std::vector<fs::path>& inputs) const {
    std::vector<std::string> paths;
    for (const fs::path& input : inputs) {
      paths.push_back(input.string());
    }
    std::vector<std::string> found;
    for (const Sequence& sequence : open_sequences(paths, {}, folder_ / "out").sequences) {
      found.push_back(sequence.label);
    }
    return found;
  }
};

using Labels = std::vector<std::string>;

TEST_F(SequencesTest, AreLabelledByTheirFolders) {
  make_recording(folder_ / "a" / "street", 3);
  make_recording(folder_ / "b" / "street");
  make_recording(folder_ / "b" / "tables");
  EXPECT_EQ(labels({folder_ / "a" / "street" / ""}), Labels{"street"});
  EXPECT_EQ(labels({folder_ / "a" / "street" / "point_clouds"}), Labels{"street"});
  EXPECT_EQ(labels({folder_ / "b" / "street", folder_ / "a" / "street"}), (Labels{"b_street", "a_street"}));
  EXPECT_EQ(labels({folder_ / "b" / "tables"}), Labels{"tables_2"}) << "tables/ is for the tables";
  const Sequence street = open_sequences({(folder_ / "a" / "street").string()}, {}, folder_ / "out").sequences[0];
  EXPECT_EQ(street.scans, 3u);
  EXPECT_EQ(street.last_stamp.ns - street.first_stamp.ns, 200'000'000);
  EXPECT_TRUE(street.object_truth.empty());
}

TEST_F(SequencesTest, AFolderOfRecordingsCountsAsAllOfThem) {
  for (const char* name : {"c", "a", "b"}) {
    make_recording(folder_ / "data" / name);
  }
  write_file(folder_ / "data" / "notes" / "readme.txt", "notes");
  write_file(folder_ / "data" / ".cache" / "x", "");
  const Sequences opened = open_sequences({(folder_ / "data").string()}, {}, folder_ / "out");
  EXPECT_EQ(labels({folder_ / "data"}), (Labels{"a", "b", "c"}));
  ASSERT_EQ(opened.skipped.size(), 1u);
  EXPECT_NE(opened.skipped[0].find("notes"), std::string::npos) << "what is left out is told";
}

TEST_F(SequencesTest, RefusesWhatIsNoRecordingOrGivenTwice) {
  write_file(folder_ / "empty" / "readme.txt", "");
  EXPECT_THROW(labels({folder_ / "empty"}), DataError);
  EXPECT_THROW(labels({folder_ / "nowhere"}), DataError);
  make_recording(folder_ / "a");
  EXPECT_THROW(labels({folder_ / "a", folder_ / "." / "a"}), UsageError);
}

TEST_F(SequencesTest, FindsTheTruthAboutObjects) {
  make_recording(folder_ / "a");
  write_file(folder_ / "a" / "objects.jsonl", "");
  const Sequences opened = open_sequences({(folder_ / "a").string()}, {}, folder_ / "out");
  EXPECT_EQ(opened.sequences[0].object_truth, folder_ / "a" / "objects.jsonl");
}

TEST_F(SequencesTest, TheChecksumSeesChangesOfContent) {
  const fs::path data = folder_ / "data";
  const std::string big(1 << 20, 'x');
  write_file(data / "scans" / "1.bin", big);
  write_file(data / "scans" / "2.bin", big);
  write_file(data / "scans" / "3.bin", big);
  write_file(data / "poses.txt", "1 2 3");
  const std::string before = content_checksum(data);
  EXPECT_EQ(content_checksum(data), before);
  write_file(data / "bench" / "results.json", "{}");
  write_file(data / ".hidden", "x");
  EXPECT_EQ(content_checksum(data, data / "bench"), before) << "the benchmark's own output and hidden files";
  fs::remove_all(data / "bench");

  write_file(data / "poses.txt", "1 2 4");
  EXPECT_NE(content_checksum(data), before) << "a small file of the same size";
  write_file(data / "poses.txt", "1 2 3");
  write_file(data / "scans" / "2.bin", big + "x");
  EXPECT_NE(content_checksum(data), before) << "a large file of another size";
  write_file(data / "scans" / "2.bin", big);
  write_file(data / "scans" / "3.bin", std::string(1 << 20, 'y'));
  EXPECT_NE(content_checksum(data), before) << "other scans of the same size";
  write_file(data / "scans" / "3.bin", big);
  EXPECT_EQ(content_checksum(data), before);
  fs::rename(data / "poses.txt", data / "ref_poses.txt");
  EXPECT_NE(content_checksum(data), before) << "another name";
}

}  // namespace
}  // namespace dynamic_icp::benchmark
