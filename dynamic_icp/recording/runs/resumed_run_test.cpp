// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// A run that ended early goes on and leaves the files of an unbroken one.
#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/checkpoint.hpp"
#include "dynamic_icp/recording/runs/run_recording.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

#include "testing/crafted_state.hpp"
#include "testing/wall_drive.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// What ends a run here and now, as an error of no known kind does.
struct Ended {};

const std::vector<std::string> kNone = {};

/// JSON without times of computation.
json without_times(json value) {
  for (const char* const key : {"ms", "ms_mean", "ms_median", "ms_p95", "fps"}) {
    value.erase(key);
  }
  return value;
}

/// All files in a folder.
std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) {
      continue;
    }
    const std::string name = entry.path().lexically_relative(folder).string();
    std::string text = formats::read_whole_file(entry.path());
    if (name == "frames.jsonl") {
      std::istringstream lines(text);
      text.clear();
      for (std::string line; std::getline(lines, line);) {
        text += without_times(json::parse(line)).dump() + "\n";
      }
    } else if (name == "summary.json") {
      text = without_times(json::parse(text)).dump();
    }
    files[name] = text;
  }
  return files;
}

/// The names of those that are not the same.
std::vector<std::string> differing(const std::map<std::string, std::string>& a,
                                   const std::map<std::string, std::string>& b) {
  std::vector<std::string> names;
  for (const auto* const files : {&a, &b}) {
    for (const auto& [name, content] : *files) {
      if (!a.contains(name) || !b.contains(name) || a.at(name) != b.at(name)) {
        names.push_back(name);
      }
    }
  }
  return names;
}

class ResumedRun : public ::testing::Test {
 protected:
  ResumedRun() {
    report::WallDrive().write(folder_);
    fs::remove_all(folder_.path() / "run");  // of the hand-made run nothing is wanted
    settings_.output = folder_.path() / "out";
    settings_.threads = 1;
    settings_.save_labels = true;
    settings_.map_file = settings_.output / "maps" / "map.ply";
    settings_.kitti_file = settings_.output / "poses.txt";
    settings_.checkpoint_s = 0.0;
    settings_.command = "run";
    callbacks_.notice = [this](const std::string& text) { notices_.push_back(text); };
  }

  [[nodiscard]] Recording recording() const { return {folder_.path() / "drive", {}}; }

  [[nodiscard]] std::optional<RunResult> run() { return run_recording(recording(), settings_, callbacks_); }

  /// Begins, or goes on, and ends before anything is done with the result of scan `last`.
  void run_until(std::size_t last) {
    RunCallbacks callbacks = callbacks_;
    callbacks.frame = [&](std::size_t index, const odometry::Frame&) {
      if (index == last) {
        throw Ended();
      }
    };
    EXPECT_THROW((void)run_recording(recording(), settings_, callbacks), Ended);
    EXPECT_FALSE(fs::exists(settings_.output));
  }

  std::map<std::string, std::string> unbroken() {
    (void)run();
    auto files = files_in(settings_.output);
    fs::remove_all(settings_.output);
    return files;
  }

  /// The folder that an ended run has left.
  [[nodiscard]] fs::path left() const {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().filename().string().starts_with(".out.partial-")) {
        return entry.path();
      }
    }
    return {};
  }

  std::string refusal() {
    try {
      (void)run();
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  }

  [[nodiscard]] bool was_told(const std::string& words) const {
    return std::any_of(notices_.begin(), notices_.end(),
                       [&](const std::string& text) { return text.find(words) != std::string::npos; });
  }

  TestFolder folder_;
  RunSettings settings_;
  RunCallbacks callbacks_;
  std::vector<std::string> notices_;
};

TEST_F(ResumedRun, EndsWithTheFilesOfAnUnbrokenOne) {
  const auto whole = unbroken();
  ASSERT_EQ(whole.count("labels/00006.bin"), 1U);
  ASSERT_EQ(whole.count("maps/map.ply"), 1U);
  EXPECT_EQ(whole.count(kCheckpointFile), 0U);
  EXPECT_EQ(whole.count(kScanRecordsFile), 0U);
  settings_.resume = true;
  for (std::size_t last = 0; last < 6; ++last) {
    run_until(last);
    settings_.command = "another";  // the run is the one that was begun
    settings_.threads = 1;
    ASSERT_TRUE(run()) << last;
    EXPECT_TRUE(last == 0 || was_told("resumed after " + std::to_string(last) + " of 6 scans"));
    settings_.command = "run";
    if (last > 0) {
      EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << last;
    }
    EXPECT_TRUE(left().empty());
    fs::remove_all(settings_.output);
  }
}

TEST_F(ResumedRun, GoesOnAgainAndAgain) {
  const auto whole = unbroken();
  settings_.resume = true;
  for (const std::size_t last : {1U, 2U, 2U, 5U}) {
    run_until(last);
  }
  ASSERT_TRUE(run());
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
}

TEST_F(ResumedRun, OfAnyMethodAndAPartOfTheScans) {
  settings_.map_file.reset();
  settings_.start = 1;
  settings_.max_frames = 4;
  for (const char* const method : {"kiss-icp", "point-to-plane"}) {
    settings_.method = method;
    settings_.config = odometry::configuration(method);
    settings_.resume = false;
    const auto whole = unbroken();
    settings_.resume = true;
    run_until(3);
    ASSERT_TRUE(run());
    EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << method;
    fs::remove_all(settings_.output);
  }
}

TEST_F(ResumedRun, AfterAStopThatKeptTheResultsSoFar) {
  const auto whole = unbroken();
  settings_.resume = true;
  settings_.checkpoint_s = 1000.0;
  std::size_t scans = 0;
  callbacks_.stop = [&] { return ++scans == 3; };
  const std::optional<RunResult> stopped = run();
  ASSERT_TRUE(stopped);
  EXPECT_TRUE(stopped->summary.stopped);
  EXPECT_EQ(stopped->summary.frames, 3U);
  EXPECT_EQ(fs::file_size(settings_.output / kScanRecordsFile), record_file_bytes(3)) << "for the one that resumes it";
  ASSERT_TRUE(run());
  EXPECT_TRUE(was_told("resumed after 3 of 6 scans"));
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
}

TEST_F(ResumedRun, WhereItIsCompleteNothingIsDone) {
  const auto whole = unbroken();
  settings_.resume = true;
  ASSERT_TRUE(run());
  const auto written = fs::last_write_time(settings_.output / "run.json");
  const std::optional<RunResult> again = run();
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->was_complete);
  EXPECT_EQ(fs::last_write_time(settings_.output / "run.json"), written);
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
  settings_.config = odometry::PaperConfig{};
  EXPECT_NE(refusal().find("cannot resume the run"), std::string::npos) << "of other settings";
  settings_.replace = true;
  EXPECT_FALSE(run().value().was_complete);
}

TEST_F(ResumedRun, WhatCouldNotBeMadeIsMadeWithTheLastScans) {
  const auto whole = unbroken();
  settings_.resume = true;
  for (const double checkpoint_s : {0.0, 1000.0}) {
    settings_.checkpoint_s = checkpoint_s;
    // In the way of the map: a folder of its name.
    callbacks_.frame = [&](std::size_t index, const odometry::Frame&) {
      if (index == 3) {
        fs::create_directories(left() / "maps" / "map.ply" / "in the way");
      }
    };
    const std::optional<RunResult> result = run();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->failures.size(), 1U);
    EXPECT_FALSE(result->map_points.has_value());
    callbacks_.frame = {};
    fs::remove_all(settings_.output / "maps");
    notices_.clear();
    ASSERT_TRUE(run());
    EXPECT_EQ(was_told("resumed after 5 of 6 scans"), checkpoint_s == 0.0);
    EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << checkpoint_s;
    fs::remove_all(settings_.output);
  }
}

TEST_F(ResumedRun, OtherSettingsAndAnotherRecordingAreRefusedByName) {
  run_until(3);
  settings_.resume = true;
  odometry::WindowOdometryConfig config;
  config.window.knot_spacing_s = 0.02;
  settings_.config = config;
  EXPECT_NE(refusal().find("window.knot_spacing_s was 0.0125 and is 0.02 now"), std::string::npos) << refusal();
  settings_.config = odometry::Config{};
  settings_.max_frames = 5;
  EXPECT_NE(refusal().find("max_frames was null and is 5 now"), std::string::npos) << refusal();
  settings_.max_frames.reset();
  EXPECT_FALSE(left().empty()) << "what was done stays";
  // The last scan that was done.
  const fs::path scan = folder_.path() / "drive" / "point_clouds" / "00003.bin";
  ASSERT_TRUE(fs::exists(scan)) << "of six";
  std::string bytes = formats::read_whole_file(scan);
  bytes[0] = static_cast<char>(bytes[0] ^ 1);
  std::ofstream(scan, std::ios::binary) << bytes;
  EXPECT_NE(refusal().find("00003.bin is not what it was"), std::string::npos) << refusal();
}

TEST_F(ResumedRun, ADamagedCheckpointAndFilesThatAreTooShortBeginAnew) {
  const auto whole = unbroken();
  settings_.resume = true;
  const auto damage = [](const fs::path& file, std::size_t length) { fs::resize_file(file, length); };
  for (const char* const name :
       {kCheckpointFile, kScanRecordsFile, "frames.jsonl", "objects.jsonl", "labels/00002.bin"}) {
    run_until(3);
    const fs::path file = left() / name;
    ASSERT_TRUE(fs::exists(file)) << name;
    if (std::string_view(name).starts_with("labels")) {
      fs::remove(file);
    } else {
      damage(file, fs::file_size(file) / 2);
    }
    notices_.clear();
    ASSERT_TRUE(run()) << name;
    EXPECT_TRUE(was_told("the run begins anew")) << name;
    EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << name;
    fs::remove_all(settings_.output);
  }
  run_until(3);
  for (const char* const name : {kCheckpointFile, kScanRecordsFile}) {
    const std::string bytes = formats::read_whole_file(left() / name);
    for (std::size_t at = 0; at < bytes.size(); at += bytes.size() / 7) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ 16);
      const fs::path kept = folder_.path() / "kept";
      fs::copy(left(), kept, fs::copy_options::recursive);
      std::ofstream(left() / name, std::ios::binary) << damaged;
      ASSERT_TRUE(run()) << name << at;
      EXPECT_EQ(differing(files_in(settings_.output), whole), kNone) << name << at;
      fs::remove_all(settings_.output);
      fs::rename(kept, folder_.path() / ".out.partial-1");
    }
  }
}

TEST_F(ResumedRun, ThroughLinksAndPipesNothingIsWritten) {
  settings_.resume = true;
  folder_.write("other", "of somebody");
  for (const char* const name : {kCheckpointFile, kScanRecordsFile, "frames.jsonl", "objects.jsonl"}) {
    for (const bool is_link : {true, false}) {
      if (!is_link && name == std::string_view(kCheckpointFile)) {
        continue;  // no checkpoint at all: the run begins anew
      }
      run_until(3);
      fs::remove(left() / name);
      if (is_link) {
        fs::create_symlink(folder_.path() / "other", left() / name);
      } else {
        ASSERT_EQ(::mkfifo((left() / name).c_str(), 0600), 0);
      }
      EXPECT_NE(refusal().find(std::string(name) + (is_link ? ": is a link" : ": is a pipe")), std::string::npos)
          << refusal();
      EXPECT_EQ(formats::read_whole_file(folder_.path() / "other"), "of somebody");
      fs::remove_all(left());
    }
  }
  run_until(3);
  fs::rename(left() / "labels", folder_.path() / "kept");
  folder_.write("kept/notes", "of somebody");
  fs::create_directory_symlink(folder_.path() / "kept", left() / "labels");
  EXPECT_NE(refusal().find("labels: is a link"), std::string::npos) << refusal();
  EXPECT_TRUE(fs::exists(folder_.path() / "kept" / "notes"));
}

TEST_F(ResumedRun, WhatAnotherUserLeftIsRefused) {
  run_until(3);
  if (::chown((left() / kCheckpointFile).c_str(), ::geteuid() + 1, static_cast<gid_t>(-1)) != 0) {
    GTEST_SKIP() << "may not give files away";
  }
  settings_.resume = true;
  EXPECT_NE(refusal().find("belongs to another user"), std::string::npos) << refusal();
}

TEST_F(ResumedRun, ACheckpointOfNoScanOrNoRunIsRefused) {
  run_until(3);
  settings_.resume = true;
  const Checkpoint written = read_checkpoint(left());
  for (const std::size_t next : {std::size_t{0}, std::size_t{6}, std::size_t{1} << 62U}) {
    Checkpoint changed = written;
    changed.next = next;
    write_checkpoint(left(), changed);
    EXPECT_NE(refusal().find("expected 1 to 5"), std::string::npos) << refusal();
  }
  for (const char* const identity : {"", "{", "{\"version\": [}"}) {
    Checkpoint changed = written;
    changed.identity = identity;
    write_checkpoint(left(), changed);
    EXPECT_NE(refusal().find("cannot resume the run: its run.json or checkpoint"), std::string::npos) << refusal();
  }
  constexpr std::size_t kDeep = 300'000;
  Checkpoint changed = written;
  changed.identity = "{\"version\": " + std::string(kDeep, '[') + std::string(kDeep, ']') + "}";
  write_checkpoint(left(), changed);
  EXPECT_NE(refusal().find("cannot resume the run: version was"), std::string::npos) << refusal();
}

TEST_F(ResumedRun, ACraftedCheckpointIsToldByNameOrDoesNoHarm) {
  settings_.resume = true;
  run_until(3);
  const Checkpoint written = read_checkpoint(left());
  const fs::path kept = folder_.path() / "kept";
  fs::copy(left(), kept, fs::copy_options::recursive);
  const RandomSource random(7);
  int told = 0;
  for (std::uint64_t k = 0; k < 16; ++k) {
    fs::remove_all(settings_.output);
    fs::remove_all(left());
    fs::copy(kept, folder_.path() / ".out.partial-1", fs::copy_options::recursive);
    Checkpoint changed = written;
    std::string& part = k % 2 == 0 ? changed.results : changed.odometry;
    crafted::remove_checksum(part);
    crafted::StateEdit(random.bits(2 * k), random.bits(2 * k + 1)).apply(part);
    StateArchive::seal(part);
    write_checkpoint(left(), changed);
    notices_.clear();
    ASSERT_TRUE(run()) << k;  // numbers that may be true are taken for it
    if (was_told("the run begins anew")) {
      ++told;
      EXPECT_TRUE(was_told((settings_.output / kCheckpointFile).string())) << notices_.front();
    }
  }
  EXPECT_GT(told, 2);
}

TEST_F(ResumedRun, WithoutItTheRunBeginsAnewAndSaysSo) {
  const auto whole = unbroken();
  run_until(3);
  ASSERT_TRUE(run());
  EXPECT_TRUE(was_told("removed"));
  EXPECT_EQ(differing(files_in(settings_.output), whole), kNone);
  EXPECT_TRUE(left().empty());
}

TEST_F(ResumedRun, AnErrorNamesWhereItGoesOn) {
  callbacks_.frame = [&](std::size_t index, const odometry::Frame&) {
    if (index == 4) {
      throw DataError("the disk is full");
    }
  };
  EXPECT_EQ(refusal(), "the disk is full (--resume continues after 4 of 6 scans)");
}

TEST_F(ResumedRun, CancelledLeavesNothing) {
  std::size_t asked = 0;
  callbacks_.cancelled = [&] { return ++asked == 4; };
  EXPECT_FALSE(run());
  EXPECT_TRUE(left().empty());
}

TEST_F(ResumedRun, WhatCannotBeResumedIsWrongUsage) {
  settings_.resume = true;
  settings_.mcap_file = settings_.output / "run.mcap";
  EXPECT_THROW((void)run(), UsageError);
}

}  // namespace
}  // namespace dynamic_icp::runs
