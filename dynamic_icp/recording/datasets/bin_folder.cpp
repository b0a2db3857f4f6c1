// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/datasets/record_guess.hpp"
#include "dynamic_icp/recording/datasets/record_shape.hpp"
#include "dynamic_icp/recording/datasets/stated_records.hpp"
#include "dynamic_icp/recording/datasets/truth_search.hpp"
#include "dynamic_icp/recording/formats/record_file.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::RecordLayout;

// The first is all that a folder named velodyne may hold: anything else there is of KITTI, which has no Doppler.
constexpr std::array<const RecordLayout*, 9> kCandidates = {
    &formats::kVod28,    &formats::kAeva29,   &formats::kAeva25,
    &formats::kBoreas40, &formats::kBoreas28, &formats::kBoreas28BeamThenTime,
    &formats::kBoreas24, &formats::kXyzdTime, &formats::kXyzd};

bool is_velodyne(const fs::path& folder) { return same_name(folder, "velodyne") && holds_files(folder, ".bin"); }

/// The first file with content; throws DataError when there is none.
fs::path first_with_points(const fs::path& folder, const std::vector<fs::path>& files) {
  const auto found = std::find_if(files.begin(), files.end(), [](const fs::path& file) {
    std::error_code unknown_size;
    return fs::file_size(file, unknown_size) > 0 && !unknown_size;
  });
  if (found == files.end()) {
    throw DataError(
        fmt::format("{}: all *.bin files are empty: their record layout cannot be recognised", folder.string()));
  }
  return *found;
}

[[noreturn]] void refuse(const fs::path& file, const std::string& content, const std::vector<fs::path>& files) {
  const std::optional<UnclearInput> shape = likely_shape(files);
  const bool is_plain =
      content.size() % formats::kXyzd.bytes == 0 && !other_shape(files, 4, formats::NumberType::kFloat32);
  if (shape && !is_plain) {
    throw *shape;
  }
  if (is_velodyne(named_path(file).parent_path())) {
    throw DataError(fmt::format(
        "{}: looks like KITTI, whose fourth number is the reflectance and not Doppler (format dicp reads it "
        "as Doppler all the same)",
        file.parent_path().string()));
  }
  if (const std::string other = without_doppler(content); !other.empty()) {
    throw DataError(fmt::format("{}: {}", file.string(), other));
  }
  std::string names;
  for (const RecordLayout* layout : kCandidates) {
    names += fmt::format("\n  {}, {} bytes{}", layout->name, layout->bytes,
                         content.size() % layout->bytes == 0 ? "" : ": does not divide the size");
  }
  if (shape) {
    throw *shape;
  }
  throw DataError(
      fmt::format("{}: {} bytes that look like no records of points with Doppler. Tried:{}\nRecords of other numbers "
                  "are read where "
                  "`columns` and `dtype` state what they are, e.g. x,y,z,doppler and int16",
                  file.string(), content.size(), names));
}

}  // namespace

fs::path find_bin_folder(const fs::path& input) {
  if (fs::is_regular_file(input)) {
    return input.extension() == ".bin" ? input : fs::path();
  }
  return holds_files(input, ".bin") ? input : find_folder(input, is_velodyne);
}

fs::path find_bin_scans(const fs::path& input) {
  if (fs::is_regular_file(input)) {
    return input;
  }
  if (holds_files(input, ".bin")) {
    return input;
  }
  if (const fs::path dicp = find_dicp(input); !dicp.empty()) {
    return dicp / "point_clouds";
  }
  return find_folder(input, [](const fs::path& below) { return holds_files(below, ".bin"); });
}

std::unique_ptr<Dataset> open_bin_folder(const fs::path& found, const OpenOptions& options) {
  const bool is_scan = fs::is_regular_file(found);
  const fs::path folder = is_scan ? named_path(found).parent_path() : found;
  RecordRecording recording;
  recording.format = "bin";
  recording.scans =
      is_scan ? stamped_files({found}, options.period_s) : stamped_files(folder, ".bin", options.period_s);
  if (!is_scan) {
    recording.truth = take_truth(folder, recording.scans);
  }
  if (states_records(options)) {
    read_as_stated(options, recording);
    return make_record_dataset(std::move(recording));
  }
  const std::vector<fs::path>& files = recording.scans.files;
  const fs::path first = first_with_points(folder, files);
  const std::size_t candidates = is_velodyne(named_path(folder)) ? 1 : kCandidates.size();
  const RecordLayout* const layout = guess_layout(first, std::span(kCandidates).first(candidates));
  if (layout == nullptr) {
    refuse(first, formats::read_whole_file(first, formats::kMaxRecordFileBytes), files);
  }
  if (layout == &formats::kXyzd) {
    if (const auto other = other_shape(files, 4, formats::NumberType::kFloat32)) {
      throw *other;
    }
  }
  recording.layout_of = [layout](const fs::path&, Stamp) -> const RecordLayout& { return *layout; };
  recording.scans.assumptions.push_back(
      fmt::format("only *.bin files: read as records of {} bytes ({}), as {} looks like", layout->bytes, layout->name,
                  first.filename().string()));
  if (layout == &formats::kVod28) {
    recording.scans.assumptions.emplace_back(
        "View-of-Delft: the Doppler is v_r, relative; points of earlier scans are left out; its frames follow the "
        "LiDAR, 10 in a second, while the radar measures 13 times: the time between scans is uncertain");
  }
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
