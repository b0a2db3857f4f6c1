// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/sequences.hpp"

#include <cmath>
#include <set>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"

#include "testing/temporary_folder.hpp"

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
  EXPECT_NE(opened.skipped[0].reason.find("notes"), std::string::npos) << "what is left out is told";
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

TEST_F(SequencesTest, ADamagedRecordingIsNotTakenApart) {
  const fs::path rec = folder_ / "data" / "rec";
  make_recording(rec);
  write_file(rec / "times" / "00001.bin", std::string(16, '\0'));  // would be a recording alone
  write_file(rec / "ref_poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 0\n");
  const auto refusal = [&](const fs::path& input) -> std::string {
    try {
      return "taken: " + labels({input}).front();
    } catch (const DataError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal(rec).find((rec / "ref_poses.txt").string() + ": line 2"), 0U) << refusal(rec);
  EXPECT_EQ(refusal(folder_ / "data").find((rec / "ref_poses.txt").string()), 0U) << refusal(folder_ / "data");
  fs::copy(rec, folder_ / "data" / "other", fs::copy_options::recursive);
  const std::string all = refusal(folder_ / "data");
  EXPECT_NE(all.find("none of the recordings in it can be read"), std::string::npos) << all;
  EXPECT_NE(all.find((rec / "ref_poses.txt").string()), std::string::npos) << all;
  make_recording(folder_ / "data" / "whole");
  EXPECT_EQ(labels({folder_ / "data"}), Labels{"whole"}) << "the damaged ones are left out, and told";
}

// Records of five numbers, of which nobody said what they are.
TEST_F(SequencesTest, WhatCouldBeReadIsProposed) {
  std::string records;
  for (int i = 0; i < 5000; ++i) {
    const float azimuth = 0.001F * static_cast<float>(i);
    for (const float value : {20.0F * std::cos(azimuth), 20.0F * std::sin(azimuth), 1.0F, 100.0F, std::cos(azimuth)}) {
      formats::append_value(records, value);
    }
  }
  for (const char* name : {"a", "b"}) {
    write_file(folder_ / "data" / name / "point_clouds" / "00000.bin", records);
  }
  try {
    labels({folder_ / "data"});
    FAIL() << "is unclear";
  } catch (const datasets::UnclearInput& error) {
    EXPECT_EQ(error.proposal().at(0).first, "columns");
    EXPECT_NE(std::string(error.what()).find("looks like records of 5"), std::string::npos) << error.what();
  }
  make_recording(folder_ / "data" / "plain");
  const Sequences opened = open_sequences({(folder_ / "data").string()}, {}, folder_ / "out");
  ASSERT_EQ(opened.skipped.size(), 2U);
  EXPECT_FALSE(opened.skipped[0].proposal.empty());
}

TEST_F(SequencesTest, LabelsHoldNoControlCharactersAndAreNoFilesOfTheBenchmark) {
  make_recording(folder_ / "a\x1b[31m\n");
  EXPECT_EQ(labels({folder_ / "a\x1b[31m\n"}), Labels{"a_[31m_"});
  make_recording(folder_ / "results.json");
  EXPECT_EQ(labels({folder_ / "results.json"}), Labels{"results.json_2"});
}

TEST_F(SequencesTest, TheContentIsThatOfEverythingThatIsRead) {
  const fs::path rec = folder_ / "rec";
  make_recording(rec, 3);
  const auto content = [&](const fs::path& input) {
    return open_sequences({input.string()}, {}, folder_ / "out").sequences.at(0).content;
  };
  for (const fs::path& input : {rec, rec / "point_clouds"}) {
    std::set<std::string> seen = {content(input)};
    const auto expect_change = [&](const char* why) {
      EXPECT_TRUE(seen.insert(content(input)).second) << input << ": " << why;
    };
    write_file(rec / "ref_poses.txt", "0 0 0 0 0 0 0 1\n0.1 0 0 0 0 0 0 1\n0.2 0 0 0 0 0 0 1\n");
    expect_change("ground truth");
    write_file(rec / "calibration.json", R"({"T_V_to_S": {"translation": {"x": 1, "y": 0, "z": 0},
                                                          "quaternion": {"w": 1, "x": 0, "y": 0, "z": 0}}})");
    expect_change("where the sensor sits");
    write_file(rec / "times" / "00001.bin", std::string(4, '\0'));
    expect_change("times of points");
    write_file(rec / "point_clouds" / "00002.bin", std::string(15, '\0') + "\x40");
    expect_change("a point of a scan in the middle");
    for (const char* name : {"ref_poses.txt", "calibration.json", "times"}) {
      fs::remove_all(rec / name);
    }
    make_recording(rec, 3);
  }
}

}  // namespace
}  // namespace dynamic_icp::benchmark
