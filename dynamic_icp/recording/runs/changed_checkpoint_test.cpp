// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
//
// What a run that ended early has left, when it is not what it was: the run begins anew, or is refused by name.
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dynamic_icp/method/base/random_source.hpp"
#include "dynamic_icp/method/base/state_archive.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/checkpoint.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

#include "testing/crafted_state.hpp"
#include "testing/resumed_run.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

using ChangedCheckpoint = ResumedRun;

TEST_F(ChangedCheckpoint, OtherSettingsAndAnotherRecordingAreRefusedByName) {
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

TEST_F(ChangedCheckpoint, ADamagedCheckpointAndFilesThatAreTooShortBeginAnew) {
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

TEST_F(ChangedCheckpoint, ThroughLinksAndPipesNothingIsWritten) {
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

TEST_F(ChangedCheckpoint, WhatAnotherUserLeftIsRefused) {
  run_until(3);
  if (::chown((left() / kCheckpointFile).c_str(), ::geteuid() + 1, static_cast<gid_t>(-1)) != 0) {
    GTEST_SKIP() << "may not give files away";
  }
  settings_.resume = true;
  EXPECT_NE(refusal().find("belongs to another user"), std::string::npos) << refusal();
}

TEST_F(ChangedCheckpoint, ACheckpointOfNoScanOrNoRunIsRefused) {
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

TEST_F(ChangedCheckpoint, ACraftedCheckpointIsToldByNameOrDoesNoHarm) {
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

}  // namespace
}  // namespace dynamic_icp::runs
