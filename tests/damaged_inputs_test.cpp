// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// Every layout with every damage: either an error that names the file and what was expected, or what docs/formats.md
// says is done about it. Made of one simulated drive in the layouts of the simulator's writers, and what lies beyond
// them written here byte by byte.
#include <algorithm>
#include <memory>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

#include "tests/damaged_recordings.hpp"

namespace dynamic_icp::tests {
namespace {

constexpr std::size_t kScans = 4;

/// What became of reading a whole recording.
struct Read {
  std::string error;                   ///< empty: none
  std::vector<std::string> sentences;  ///< warnings and assumptions
  std::size_t scans = 0;
  std::size_t truth = 0;
  std::vector<std::size_t> points;
  std::vector<std::size_t> usable;

  [[nodiscard]] std::string text() const {
    std::string all = error.empty() ? "read" : "ERROR " + error;
    for (const std::string& sentence : sentences) {
      all += "\n    " + sentence;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      all += (i == 0 ? "\n    usable " : " ") + std::to_string(usable[i]) + "/" + std::to_string(points[i]);
    }
    return all + " truth " + std::to_string(truth);
  }
};

Read read_all(const fs::path& recording, const std::string& format) {
  Read read;
  try {
    datasets::OpenOptions options;
    options.format = format;
    const std::unique_ptr<datasets::Dataset> dataset = datasets::open_dataset(recording, options);
    read.scans = dataset->size();
    read.truth = dataset->ground_truth().size();
    read.sentences = dataset->assumptions();
    for (std::size_t i = 0; i < dataset->size(); ++i) {
      EXPECT_TRUE(i == 0 || dataset->stamp(i - 1) < dataset->stamp(i));
      const RawScan raw = dataset->scan(i);
      (void)dataset->columns(i);
      read.points.push_back(raw.points.size());
      read.usable.push_back(Scan::from_raw(raw).size());
      if (!raw.warning.empty()) {
        read.sentences.push_back(raw.warning);
      }
    }
  } catch (const DataError& error) {
    read.error = error.what();
  }
  return read;
}

class DamagedInputs : public ProgramTest {
 protected:
  /// An undamaged recording of the layout.
  fs::path whole(const Layout& layout) {
    const fs::path path = folder_ / "whole" / layout.name;
    if (fs::exists(path)) {
      return path;
    }
    if (layout.record_bytes > 0 && layout.name != "bin") {
      simulate(layout.name, path);
    } else if (layout.name == "aevascenes") {
      simulate(layout.name, path);
      const std::vector<RawScan> scans = measured();
      const std::vector<fs::path> files = scan_files(layout, path);
      for (std::size_t i = 0; i < kScans; ++i) {
        write_file(files.at(i), file_of(layout.name, scans[i], Numbers::kAsMeasured));
      }
    } else {
      write_columns(layout, path);
    }
    return path;
  }

  fs::path damaged(const Layout& layout, const std::string& damage) {
    const fs::path path = folder_ / "damaged" / layout.name / damage;
    fs::create_directories(path.parent_path());
    fs::copy(whole(layout), path, fs::copy_options::recursive);
    return path;
  }

  /// The scans of the drive.
  const std::vector<RawScan>& measured() {
    if (scans_.empty()) {
      const std::unique_ptr<datasets::Dataset> dataset = datasets::open_dataset(whole(layout_of("hercules")));
      for (std::size_t i = 0; i < dataset->size(); ++i) {
        scans_.push_back(dataset->scan(i));
      }
    }
    return scans_;
  }

 private:
  static void simulate(const std::string& layout, const fs::path& path) {
    fs::create_directories(path.parent_path());
    const Outcome made =
        run_program("simulate city --quiet --frames 4 --set lidar.columns=60 --set lidar.rows=10 --layout " + layout +
                    " --output " + path.string());
    ASSERT_EQ(made.status, 0) << made.text;
    if (layout != "dicp") {
      fs::remove(path / "ref_poses.txt");  // the simulator's own truth beside that of the layout
    }
  }

  void write_columns(const Layout& layout, const fs::path& path) {
    const fs::path source = whole(layout_of("hercules"));
    for (std::size_t i = 0; i < kScans; ++i) {
      const std::string stem = scan_files(layout_of("hercules"), source).at(i).stem().string();
      const RawScan& scan = measured().at(i);
      if (layout.name == "npy-pair") {
        write_file(path / (stem + ".npy"), file_of(layout.name, scan, Numbers::kAsMeasured));
        write_file(path / (stem + "_dop.npy"), doppler_file_of(scan));
      } else {
        write_file(path / (stem + layout.extension), file_of(layout.name, scan, Numbers::kAsMeasured));
      }
    }
    if (!layout.truth.empty()) {
      fs::copy_file(source / "PR_GT" / "Aeva_gt.txt", path / layout.truth);
    }
  }

  std::vector<RawScan> scans_;
};

TEST_F(DamagedInputs, TheUndamagedOnesAreWhole) {
  for (const Layout& layout : layouts()) {
    SCOPED_TRACE(layout.name);
    const Read read = read_all(whole(layout), format_of(layout));
    EXPECT_EQ(read.error, "");
    EXPECT_EQ(read.scans, kScans);
    EXPECT_EQ(read.truth > 0, !(layout.truth.empty() && layout.name != "aevascenes"));
    for (std::size_t i = 0; i < read.points.size(); ++i) {
      EXPECT_EQ(read.points[i], measured()[i].points.size());
      EXPECT_EQ(read.usable[i], read.points[i]);
    }
  }
}

/// How much of the damaged scan is left where it is read.
enum class Left { kNothingRead, kAll, kSome, kNoPoint, kNoScan };

/// What becomes of a damage in some layouts.
struct Expected {
  std::string damage;
  std::string layouts;  ///< by blanks
  Left left;            ///< kNothingRead: an error
  std::string names;    ///< what the error names, or the sentence that is said: the end of the path of a file
  std::string words;    ///< what stands behind it
};

const std::string kRecords = "hercules helipr boreas bin";
const std::string kColumns = "npz npy-pair pcd-ascii pcd-binary pcd-compressed ply";

// FILE stands for the damaged scan.
const std::vector<Expected>& expectations() {
  static const std::vector<Expected> all_expectations = {
      {"truncated", "dicp", Left::kNothingRead, "FILE", "329 points, expected 549 as there are times in"},
      {"truncated", kRecords, Left::kSome, "FILE", "bytes after record 329 are left out"},
      {"truncated", "aevascenes npz", Left::kNothingRead, "FILE", "a zip archive without an end: cut short at byte 55"},
      {"truncated", "npy-pair", Left::kNothingRead, "FILE", "expected 6588 bytes of data for shape (549, 3)"},
      {"truncated", "pcd-ascii", Left::kNothingRead, "FILE", "the file ends after 332 points, expected 549"},
      {"truncated", "pcd-binary", Left::kNothingRead, "FILE", "549 points of 16 bytes each after the header, expected"},
      {"truncated", "pcd-compressed", Left::kNothingRead, "FILE", "9059 bytes of compressed data, expected at most"},
      {"truncated", "ply", Left::kNothingRead, "FILE", "549 records of element 'vertex', expected at most 325"},

      {"empty file", "dicp", Left::kNothingRead, "FILE", "0 points, expected 549 as there are times in"},
      {"empty file", kRecords, Left::kNoPoint, "FILE", "empty file, taken as a scan without points"},
      {"empty file", "aevascenes npz", Left::kNothingRead, "FILE", "empty file, expected a zip archive of arrays"},
      {"empty file", "npy-pair", Left::kNothingRead, "FILE", "is no NPY array, expected it to begin with"},
      {"empty file", "pcd-ascii pcd-binary pcd-compressed", Left::kNothingRead, "FILE", "line 1: the file ends within"},
      {"empty file", "ply", Left::kNothingRead, "FILE", "line 1: is no PLY, expected"},

      {"wrong size", "dicp " + kRecords, Left::kAll, "FILE", "5 bytes after record 549 are left out"},
      {"wrong size", "aevascenes npz", Left::kAll, "", ""},  // zip archives may have something behind them
      {"wrong size", "npy-pair", Left::kNothingRead, "FILE", "expected 6588 bytes of data for shape (549, 3)"},
      {"wrong size", "pcd-ascii", Left::kNothingRead, "FILE", "line 559: a point after the last one, expected 549"},
      {"wrong size", "pcd-binary", Left::kAll, "FILE", "5 bytes after the last of 549 points are left out"},
      {"wrong size", "pcd-compressed", Left::kAll, "FILE", "5 bytes after the compressed data are left out"},
      {"wrong size", "ply", Left::kNothingRead, "FILE", "5 bytes after the last record, expected the end"},

      {"other byte order", "dicp " + kRecords, Left::kNothingRead, "FILE", "record 0 at byte 0 has x, y, z = "},
      {"other byte order", "aevascenes npz npy-pair pcd-binary pcd-compressed ply", Left::kNothingRead, "FILE",
       "point 0 has x, y, z = "},

      {"NaN", "dicp aevascenes " + kRecords + " " + kColumns, Left::kNoPoint, "", ""},

      {"duplicate stamps", "dicp", Left::kNothingRead, "ref_poses.txt", "line 4: the time stamp 0.200000000 occurs a"},
      {"duplicate stamps", kRecords, Left::kNothingRead, "copy_FILE", "carries the same time stamp as"},
      {"duplicate stamps", "npz pcd-ascii pcd-binary pcd-compressed ply", Left::kNothingRead, "copy_FILE",
       "carries the same time stamp as"},
      {"duplicate stamps", "npy-pair", Left::kNothingRead, "_dop.npy", "carries the same time stamp as"},
      {"duplicate stamps", "aevascenes", Left::kNothingRead, "sequence.json",
       "frames: two frames have the timestamp_ns"},

      {"unsorted stamps", "dicp", Left::kNothingRead, "ref_poses.txt",
       "line 4: the time stamp 0.200000000 comes after"},
      {"unsorted stamps", "hercules helipr", Left::kNothingRead, "Aeva_gt.txt", "line 4: the time stamp "},
      {"unsorted stamps", "boreas", Left::kNothingRead, "aeva_poses.csv", "line 5: the time stamp "},
      {"unsorted stamps", "aevascenes", Left::kAll, "", ""},  // put in order
      {"unsorted stamps", kColumns, Left::kAll, "not used as ground truth: ", "line 4: the time stamp "},

      {"missing truth", "dicp", Left::kAll, "no ref_poses.txt: ", "a scan period of 0.1 s is assumed"},
      {"missing truth", "hercules helipr boreas " + kColumns, Left::kAll, "", ""},
      {"missing truth", "aevascenes", Left::kAll, "sequence.json", "4 of 4 frames have no ego_pose"},

      {"spoiled truth", "dicp", Left::kNothingRead, "ref_poses.txt", "line 4: qw is '"},
      {"spoiled truth", "hercules helipr", Left::kNothingRead, "Aeva_gt.txt", "line 4: qw is '"},
      {"spoiled truth", "boreas", Left::kNothingRead, "aeva_poses.csv", "line 5: '"},
      {"spoiled truth", kColumns, Left::kAll, "not used as ground truth: ", "line 4: qw is '"},

      {"missing metadata", "aevascenes", Left::kNothingRead, "missing metadata", "expected sequence.json beside"},
      {"missing metadata", "npy-pair", Left::kNoScan, "FILE", "1 of the *.npy have no *_dop.npy beside them"},
      {"missing metadata", "pcd-ascii pcd-binary pcd-compressed", Left::kNothingRead, "FILE", "line 1: no FIELDS in"},
      {"missing metadata", "ply", Left::kNothingRead, "FILE", "2196 bytes after the last record, expected"},

      {"spoiled metadata", "dicp", Left::kNothingRead, "calibration.json", "expected {\"T_V_to_S\": "},
      {"spoiled metadata", "hercules", Left::kNothingRead, "IMU_LiDAR.txt", "line 1: 'three' is no number"},
      {"spoiled metadata", "boreas", Left::kNothingRead, "T_applanix_lidar.txt", "is no number"},
      {"spoiled metadata", "aevascenes", Left::kNothingRead, "sequence.json", "metadata: expected the metadata"},

      {"huge count", "aevascenes npz npy-pair", Left::kNothingRead, "FILE", "expected 1199999999999988 bytes of data"},
      {"huge count", "pcd-ascii", Left::kNothingRead, "FILE", "99999999999999 points of 4 numbers each, expected"},
      {"huge count", "pcd-binary", Left::kNothingRead, "FILE", "99999999999999 points of 16 bytes each after the"},
      {"huge count", "pcd-compressed", Left::kNothingRead, "FILE", "4294967295 bytes of compressed data, expected"},
      {"huge count", "ply", Left::kNothingRead, "FILE", "99999999999999 records of element 'vertex', expected"}};
  return all_expectations;
}

/// The one expectation of a damage in a layout.
const Expected* expected_of(const std::string& damage, const std::string& layout) {
  const Expected* found = nullptr;
  for (const Expected& expected : expectations()) {
    if (expected.damage == damage && (" " + expected.layouts + " ").find(" " + layout + " ") != std::string::npos) {
      EXPECT_EQ(found, nullptr) << "twice";
      found = &expected;
    }
  }
  return found;
}

bool says(const std::string& sentence, const Expected& expected, const fs::path& file) {
  const std::size_t name = sentence.find(replaced(expected.names, "FILE", file.filename().string()));
  return name != std::string::npos && sentence.find(expected.words, name) != std::string::npos;
}

void expect_read(const Read& read, const Expected& expected, const fs::path& file, const std::vector<RawScan>& whole) {
  ASSERT_EQ(read.error, "");
  ASSERT_EQ(read.scans, expected.left == Left::kNoScan ? kScans - 1 : kScans);
  const bool said = std::any_of(read.sentences.begin(), read.sentences.end(),
                                [&](const std::string& sentence) { return says(sentence, expected, file); });
  EXPECT_TRUE(said || expected.names.empty()) << read.text();
  if (expected.left == Left::kNoPoint) {
    EXPECT_EQ(read.usable[1], 0u);
  } else if (expected.left == Left::kSome) {
    EXPECT_EQ(read.usable[1], 329u);
  } else if (expected.left == Left::kAll && expected.damage != "unsorted stamps") {
    EXPECT_EQ(read.usable[1], whole[1].points.size());
  }
}

TEST_F(DamagedInputs, AreRefusedByNameOrReadAsDocumented) {
  std::size_t met = 0;
  for (const auto& [name, damage] : damages()) {
    for (const Layout& layout : layouts()) {
      SCOPED_TRACE(name + " | " + layout.name);
      const fs::path recording = damaged(layout, name);
      const fs::path file = scan_files(layout, recording).at(1);
      if (!damage(layout, recording, file, measured().at(1))) {
        continue;
      }
      ++met;
      const Expected* const expected = expected_of(name, layout.name);
      const Read read = read_all(recording, "auto");
      ASSERT_NE(expected, nullptr) << read.text();
      if (expected->left != Left::kNothingRead) {
        expect_read(read, *expected, file, measured());
      } else {
        EXPECT_TRUE(says(read.error, *expected, file)) << read.text();
      }
      if (name == "missing truth" || (name == "spoiled truth" && read.error.empty())) {
        EXPECT_EQ(read.truth, 0u);
      }
    }
  }
  EXPECT_EQ(met, 120u) << "no damage may go missing from the matrix unseen";
}

}  // namespace
}  // namespace dynamic_icp::tests
