// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/helipr.hpp"

#include <array>
#include <system_error>

#include "dynamic_icp/recording/datasets/aeva_folder.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/datasets/record_guess.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::RecordLayout;

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

fs::path find_helipr(const fs::path& input) {
  const fs::path folder = find_aeva_folder(input);
  return !folder.empty() && !is_hercules(folder) ? folder : fs::path();
}

std::unique_ptr<Dataset> open_helipr(const fs::path& folder, const OpenOptions& options) {
  StampedFiles scans = stamped_files(child(folder, "LiDAR/Aeva"), ".bin", options.period_s);
  RecordRecording recording;
  recording.format = "helipr";
  recording.layout_of = layout_of;
  recording.files = std::move(scans.files);
  recording.stamps = std::move(scans.stamps);
  recording.assumptions = std::move(scans.assumptions);
  recording.assumptions.emplace_back(
      "the Doppler is taken as relative, the sensor's own motion in it; this is uncertain: the data set's author says "
      "it was taken out, published work uses it as if not; the diagnosis checks it against the motion; a stated "
      "Doppler kind decides");
  recording.truth = named_truth(
      std::array{find_part(folder, "LiDAR_GT/Aeva_gt.txt"), find_part(folder, "LiDAR_GT/global_Aeva_gt.txt")},
      recording.stamps, recording.assumptions);
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
