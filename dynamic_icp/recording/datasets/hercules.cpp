// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/hercules.hpp"

#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/aeva_folder.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

}  // namespace

Eigen::Isometry3d read_imu_lidar(const fs::path& path) {
  constexpr std::string_view kKey = "Tr_lidar_to_imu:";
  const std::string text = formats::read_text_file(path);
  std::string_view rest = text;
  std::size_t number = 1;
  for (std::optional<std::string_view> line = formats::take_line(rest); line; line = formats::take_line(rest)) {
    if (const std::size_t key = line->find(kKey); key != std::string_view::npos) {
      const std::string place = fmt::format("{}: line {}", path.string(), number);
      return rigid_transform(numbers_in(line->substr(key + kKey.size()), place), place);
    }
    ++number;
  }
  throw DataError(fmt::format("{}: no line '{}' with 12 numbers", path.string(), kKey));
}

fs::path find_hercules(const fs::path& input) {
  const fs::path folder = find_aeva_folder(input);
  return !folder.empty() && is_hercules(folder) ? folder : fs::path();
}

std::unique_ptr<Dataset> open_hercules(const fs::path& folder, const OpenOptions& options) {
  StampedFiles scans = stamped_files(child(folder, "LiDAR/Aeva"), ".bin", options.period_s);
  RecordRecording recording;
  recording.format = "hercules";
  recording.layout_of = [](const fs::path&, Stamp) -> const formats::RecordLayout& { return formats::kAeva29; };
  recording.files = std::move(scans.files);
  recording.stamps = std::move(scans.stamps);
  recording.assumptions = std::move(scans.assumptions);
  recording.truth =
      named_truth(std::array{find_part(folder, "PR_GT/Aeva_gt.txt")}, recording.stamps, recording.assumptions);
  if (const fs::path calibration = find_part(folder, "Calibration/IMU_LiDAR.txt"); !calibration.empty()) {
    recording.T_vehicle_sensor = read_imu_lidar(calibration);
  }
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
