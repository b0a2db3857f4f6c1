// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
// HeRCULES and HeLiPR: scans of an Aeva sensor in LiDAR/Aeva/<stamp_ns>.bin and what lies beside them, in any spelling
// of upper and lower case.
#include <array>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/datasets/record_guess.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::RecordLayout;

constexpr Stamp kStartOf2024{1'704'067'200'000'000'000};

bool holds_aeva(const fs::path& folder) {
  const fs::path scans = child(folder, "LiDAR/Aeva");
  return !scans.empty() && holds_files(scans, ".bin");
}

/// A file or folder of the recording; empty when there is none. Archives of one recording may have been unpacked into
/// folders of their own: what is not in `folder` is looked for in the one above and in those beside it that hold no
/// scans themselves.
fs::path find_part(const fs::path& folder, std::string_view name) {
  const fs::path above = named_path(folder).parent_path();
  for (const fs::path& place : {folder, above}) {
    if (fs::path found = child(place, name); !found.empty()) {
      return found;
    }
  }
  const auto is_part = [](const fs::directory_entry& entry) {
    std::error_code ignored;
    return entry.is_directory(ignored) && !holds_aeva(entry.path());
  };
  for (const fs::path& part : entries_of(above, is_part)) {
    if (fs::path found = child(part, name); !found.empty()) {
      return found;
    }
  }
  return {};
}

/// Whether such a folder is of HeRCULES: it has PR_GT or Radar, or its first scan is of 2024 or later.
bool is_hercules(const fs::path& folder) {
  return !find_part(folder, "PR_GT").empty() || !find_part(folder, "Radar").empty() ||
         stamped_files(child(folder, "LiDAR/Aeva"), ".bin", 0.1).stamps.front() >= kStartOf2024;
}

// Scans up to this one (2023-08-13 14:22:37 UTC) have no intensity.
constexpr Stamp kLastWithoutIntensity{1'691'936'557'946'849'179};

/// By the stamp, unless the size of the file fits the other layout alone, and its content does too.
const RecordLayout& layout_of(const fs::path& file, Stamp stamp) {
  const bool is_older = stamp <= kLastWithoutIntensity;
  const RecordLayout& expected = is_older ? formats::kAeva25 : formats::kAeva29;
  const RecordLayout& other = is_older ? formats::kAeva29 : formats::kAeva25;
  std::error_code unknown_size;
  const std::uintmax_t bytes = fs::file_size(file, unknown_size);
  if (unknown_size || bytes % expected.bytes == 0 || bytes % other.bytes != 0) {
    return expected;
  }
  const RecordLayout* const guess = guess_layout(file, std::array{&other});
  return guess != nullptr ? *guess : expected;
}

}  // namespace

fs::path find_aeva_folder(const fs::path& input) {
  const fs::path whole = named_path(input);
  const fs::path above = same_name(whole, "Aeva") ? whole.parent_path() : whole;
  if (same_name(above, "LiDAR") && holds_aeva(above.parent_path())) {
    return above.parent_path();
  }
  return find_folder(input, holds_aeva);
}

Eigen::Isometry3d read_imu_lidar(const fs::path& path) {
  constexpr std::string_view kKey = "Tr_lidar_to_imu:";
  for (const auto& [place, line] : formats::read_lines(path)) {
    if (const std::size_t key = line.find(kKey); key != std::string::npos) {
      return rigid_transform(numbers_in(std::string_view(line).substr(key + kKey.size()), place), place);
    }
  }
  throw DataError(fmt::format("{}: no line '{}' with 12 numbers", path.string(), kKey));
}

fs::path find_hercules(const fs::path& input) {
  const fs::path folder = find_aeva_folder(input);
  return !folder.empty() && is_hercules(folder) ? folder : fs::path();
}

std::unique_ptr<Dataset> open_hercules(const fs::path& folder, const OpenOptions& options) {
  RecordRecording recording;
  recording.scans = stamped_files(child(folder, "LiDAR/Aeva"), ".bin", options.period_s);
  recording.format = "hercules";
  recording.layout_of = [](const fs::path&, Stamp) -> const formats::RecordLayout& { return formats::kAeva29; };
  recording.truth = named_truth(std::array{find_part(folder, "PR_GT/Aeva_gt.txt")}, recording.scans.stamps,
                                recording.scans.assumptions);
  if (const fs::path calibration = find_part(folder, "Calibration/IMU_LiDAR.txt"); !calibration.empty()) {
    recording.T_vehicle_sensor = read_imu_lidar(calibration);
  }
  return make_record_dataset(std::move(recording));
}

fs::path find_helipr(const fs::path& input) {
  const fs::path folder = find_aeva_folder(input);
  return !folder.empty() && !is_hercules(folder) ? folder : fs::path();
}

std::unique_ptr<Dataset> open_helipr(const fs::path& folder, const OpenOptions& options) {
  RecordRecording recording;
  recording.scans = stamped_files(child(folder, "LiDAR/Aeva"), ".bin", options.period_s);
  recording.format = "helipr";
  recording.layout_of = layout_of;
  recording.doppler_kind = DopplerKind::kCompensated;
  recording.scans.assumptions.emplace_back(
      "the Doppler is taken as compensated, as the authors of the data set say; where it is not the diagnosis finds "
      "it, and a stated Doppler kind decides");
  recording.truth = named_truth(
      std::array{find_part(folder, "LiDAR_GT/Aeva_gt.txt"), find_part(folder, "LiDAR_GT/global_Aeva_gt.txt")},
      recording.scans.stamps, recording.scans.assumptions);
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
