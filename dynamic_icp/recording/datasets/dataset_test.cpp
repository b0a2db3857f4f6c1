// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/dataset.hpp"

#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

class OpenDataset : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_ = fs::temp_directory_path() / ("dataset_test-" + std::to_string(::getpid()));
};

TEST_F(OpenDataset, AMissingInputIsNamed) {
  try {
    open_dataset(folder_ / "no");
    FAIL() << "must throw";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find((folder_ / "no").string()), std::string::npos);
  }
}

TEST_F(OpenDataset, AnUnknownLayoutSaysWhatWasLookedFor) {
  try {
    open_dataset(folder_);
    FAIL() << "must throw";
  } catch (const NotARecording& error) {
    EXPECT_NE(std::string(error.what()).find("point_clouds/*.bin"), std::string::npos);
  }
  EXPECT_THROW(open_dataset(folder_, {.format = "dicp"}), DataError);
}

TEST_F(OpenDataset, RecordingsOfSeveralLayoutsSideBySideAreRefused) {
  const auto write = [&](const fs::path& path, std::size_t bytes) {
    fs::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path, std::ios::binary) << std::string(bytes, '\0');
  };
  write("a/point_clouds/00001.bin", 16);
  EXPECT_EQ(open_dataset(folder_)->format(), "dicp");
  write(".b.partial-1/LiDAR/Aeva/1735689600000000000.bin", 29);
  EXPECT_EQ(open_dataset(folder_)->format(), "dicp") << "what is not finished does not count";
  write("a/run/map.ply", 1);
  EXPECT_EQ(open_dataset(folder_)->format(), "dicp") << "nor does what lies in the recording";
  write("b/LiDAR/Aeva/1735689600000000000.bin", 29);
  try {
    open_dataset(folder_);
    FAIL() << "which one?";
  } catch (const NotARecording& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("several recordings"), std::string::npos) << message;
    EXPECT_NE(message.find((folder_ / "a").string() + " (dicp)"), std::string::npos) << message;
    EXPECT_NE(message.find((folder_ / "b").string()), std::string::npos) << message;
  }
  EXPECT_EQ(open_dataset(folder_ / "a")->format(), "dicp");
  EXPECT_EQ(open_dataset(folder_, {.format = "hercules"})->format(), "hercules");
}

TEST_F(OpenDataset, AFolderInARecordingIsNoRecording) {
  const auto write_numbers = [&](const fs::path& path, const std::vector<float>& numbers) {
    fs::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path, std::ios::binary)
        .write(reinterpret_cast<const char*>(numbers.data()), static_cast<std::streamsize>(4 * numbers.size()));
  };
  std::vector<float> times;
  for (int i = 0; i < 4000; ++i) {
    times.push_back(2.5e-5F * static_cast<float>(i));
  }
  write_numbers("drive/point_clouds/00001.bin", {10, 2, 1, -3});
  write_numbers("drive/times/00001.bin", times);
  std::ofstream(folder_ / "drive/poses.dat") << "none";
  fs::create_directories(folder_ / "drive/notes");
  std::ofstream(folder_ / "drive/notes/a.dat") << "none";
  for (const char* part : {"drive/times", "drive/times/", "drive/times/00001.bin", "drive/notes"}) {
    try {
      open_dataset(folder_ / part);
      ADD_FAILURE() << part << " must be refused";
    } catch (const NotARecording& error) {
      EXPECT_NE(std::string(error.what())
                    .find("is a part of the recording " + (folder_ / "drive").string() + " (dicp), not one itself"),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_EQ(open_dataset(folder_ / "drive/point_clouds")->format(), "dicp");
  fs::rename(folder_ / "drive/times", folder_ / "times");
  EXPECT_NO_THROW((void)open_dataset(folder_ / "times")) << "four of these numbers are as good as any others";
}

TEST_F(OpenDataset, ChoicesThatALayoutDoesNotHaveAreRefused) {
  fs::create_directories(folder_ / "point_clouds");
  std::ofstream(folder_ / "point_clouds" / "1.bin", std::ios::binary) << std::string(16, '\0');
  EXPECT_THROW(open_dataset(folder_, {.fields = {{"doppler", "v"}}}), UsageError);
  EXPECT_THROW(open_dataset(folder_, {.sensors = {"front"}}), UsageError);
  EXPECT_THROW(open_dataset(folder_, {.topics = {"/points"}}), UsageError);
  EXPECT_THROW(open_dataset(folder_, {.truth_topic = "/pose"}), UsageError);
}

TEST_F(OpenDataset, ArchivesAndTheLikeAreNamed) {
  const auto fault = [&](const fs::path& input) -> std::string {
    try {
      open_dataset(input);
    } catch (const DataError& error) {
      return error.what();
    }
    return "no error";
  };
  std::ofstream(folder_ / "b.tar.gz", std::ios::binary) << std::string("\x1F\x8B\x08\0\0\0\0\0\0\x03", 10);
  EXPECT_EQ(fault(folder_), (folder_ / "b.tar.gz").string() +
                                ": is compressed with gzip; unpack it first ('gunzip', or 'tar xzf' for a .tar.gz)");
  std::ofstream(folder_ / "a.zip", std::ios::binary) << "PK\x03\x04";
  EXPECT_EQ(fault(folder_), (folder_ / "a.zip").string() + ": is a zip archive; unpack it first");
  EXPECT_EQ(fault(folder_ / "a.zip"), fault(folder_));
  std::ofstream(folder_ / "drive.mcap", std::ios::binary) << "\x89MCAP0\r\n";
  EXPECT_EQ(fault(folder_ / "drive.mcap").find((folder_ / "drive.mcap").string()), 0U);  // damaged, but a recording
  std::ofstream(folder_ / "old.bag", std::ios::binary) << "#ROSBAG V1.2\n";
  EXPECT_NE(fault(folder_ / "old.bag").find("is a ROS bag from before version 2.0"), std::string::npos);
  std::ofstream(folder_ / "notes.txt") << "nothing";
  EXPECT_NE(fault(folder_ / "notes.txt").find("not a recording of a known layout"), std::string::npos);
}

TEST_F(OpenDataset, AnUnknownFormatNameIsWrongUse) {
  EXPECT_THROW(open_dataset(folder_, {.format = "vhs"}), UsageError);
  const std::vector<std::string> known = known_formats();
  for (const char* format : {"dicp", "hercules", "helipr", "boreas", "aevascenes", "rosbag", "rosbag2", "mcap", "npz",
                             "pcd", "ply", "bin"}) {
    EXPECT_NE(std::find(known.begin(), known.end(), format), known.end()) << format;
  }
}

}  // namespace
}  // namespace dynamic_icp::datasets
