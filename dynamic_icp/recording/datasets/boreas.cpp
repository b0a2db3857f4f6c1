// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/boreas_doppler_tables.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/numbered_files.hpp"
#include "dynamic_icp/recording/datasets/record_dataset.hpp"
#include "dynamic_icp/recording/datasets/record_guess.hpp"
#include "dynamic_icp/recording/formats/text_lines.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::RecordLayout;

constexpr std::array<const RecordLayout*, 5> kRecordLayouts = {&formats::kBoreas40, &formats::kBoreas28,
                                                               &formats::kBoreas28BeamThenTime, &formats::kBoreas24,
                                                               &formats::kBoreas32};

void check_rows(const fs::path& path, std::size_t rows, std::size_t scans) {
  if (rows != scans) {
    throw DataError(fmt::format("{}: {} lines for {} scans, expected one per scan", path.string(), rows, scans));
  }
}

bool holds_frames(const fs::path& folder) {
  return holds_files(child(folder, "frames"), ".bin") && !child(folder, "timestamps.txt").empty();
}

bool is_boreas(const fs::path& folder) {
  const bool is_rt = holds_files(child(folder, "aeva"), ".bin") &&
                     (!child(folder, "applanix").empty() || !child(folder, "calib").empty());
  return is_rt || (holds_frames(folder) && !child(folder, "aeva_poses.txt").empty());
}

/// The folder above when the input is that of the scans itself.
fs::path find_above(const fs::path& input, bool (*wanted)(const fs::path&)) {
  const fs::path whole = named_path(input);
  if ((same_name(whole, "aeva") || same_name(whole, "frames")) && wanted(whole.parent_path())) {
    return whole.parent_path();
  }
  return find_folder(input, wanted);
}

/// Told by the first scan with points; where its content is no help, by the size alone.
const RecordLayout& layout_of(const std::vector<fs::path>& files) {
  const auto holds_points = [](const fs::path& file) {
    std::error_code unknown_size;
    return fs::file_size(file, unknown_size) > 0 && !unknown_size;
  };
  const auto first = std::find_if(files.begin(), files.end(), holds_points);
  if (first == files.end()) {
    return *kRecordLayouts.front();
  }
  if (const RecordLayout* const guess = guess_layout(*first, kRecordLayouts)) {
    return *guess;
  }
  const auto fits = std::find_if(kRecordLayouts.begin(), kRecordLayouts.end(), [&](const RecordLayout* layout) {
    return fs::file_size(*first) % layout->bytes == 0;
  });
  return fits == kRecordLayouts.end() ? *kRecordLayouts.front() : **fits;
}

/// Why bias tables do not go with scans of this layout; empty where they do.
std::string_view contradiction_to_tables(const RecordLayout& layout) {
  if (&layout == &formats::kBoreas40) {
    return "they are of the sensor of Boreas-Aeva, and the scans are of Boreas-RT";
  }
  if (&layout == &formats::kBoreas24) {
    return "they go by beam, and the scans do not say the beam of a point";
  }
  if (&layout == &formats::kBoreas32) {
    return "they are of one sensor, and the scans may be of several";
  }
  return "";
}

/// Has the bias tables that lie beside the scans taken out of the Doppler, and says what becomes of the bias.
void correct_doppler(const fs::path& folder, const RecordLayout& layout, RecordRecording& recording) {
  std::vector<std::string>& assumptions = recording.scans.assumptions;
  const bool is_older = &layout != &formats::kBoreas40;
  const fs::path tables_folder = find_boreas_doppler_tables(folder);
  const std::string_view contradiction = contradiction_to_tables(layout);
  std::string bias;
  if (tables_folder.empty()) {
    bias = is_older ? "no tables of Doppler bias lie beside them (aeva_calib/), so their Doppler is not corrected" : "";
  } else if (!contradiction.empty()) {
    bias = fmt::format("the tables of Doppler bias in {} are not applied: {}", tables_folder.string(), contradiction);
  } else {
    bias = fmt::format("their Doppler is corrected by the tables of bias in {}", tables_folder.string());
    recording.correct = [tables = read_boreas_doppler_tables(tables_folder)](RawScan& scan, const fs::path& file) {
      subtract_boreas_doppler_bias(tables, file, scan);
    };
  }
  if (is_older) {
    bias = fmt::format("the scans are read as records of {} bytes (Boreas-Aeva); {}", layout.bytes, bias);
  }
  if (!bias.empty()) {
    assumptions.push_back(std::move(bias));
  }
  if (const fs::path model = find_doppler_odom_model(folder); !model.empty()) {
    assumptions.push_back(
        fmt::format("{} is of a model of Doppler bias for doppler_odom, which is not read", model.string()));
  }
}

RecordRecording aeva_recording(const fs::path& folder, const OpenOptions& options) {
  RecordRecording recording;
  recording.scans = stamped_files(child(folder, "aeva"), ".bin", options.period_s);
  const RecordLayout& layout = layout_of(recording.scans.files);
  recording.layout_of = [&layout](const fs::path&, Stamp) -> const RecordLayout& { return layout; };
  correct_doppler(folder, layout, recording);
  if (const fs::path poses = child(folder, "applanix/aeva_poses.csv"); !poses.empty()) {
    recording.truth = {read_boreas_poses(poses), poses};
  }
  const fs::path T_applanix_lidar = child(folder, "calib/T_applanix_lidar.txt");
  const fs::path T_aeva_lidar = child(folder, "calib/T_aeva_lidar.txt");
  if (!T_applanix_lidar.empty() && !T_aeva_lidar.empty()) {
    recording.T_vehicle_sensor = read_boreas_matrix(T_applanix_lidar) * read_boreas_matrix(T_aeva_lidar).inverse();
  }
  return recording;
}

RecordRecording frames_recording(const fs::path& folder) {
  RecordRecording recording;
  recording.scans.files = numbered_files(child(folder, "frames"), ".bin");
  recording.layout_of = [](const fs::path&, Stamp) -> const RecordLayout& { return formats::kXyzdTime; };
  const fs::path times = child(folder, "timestamps.txt");
  recording.scans.stamps = read_boreas_times(times);
  check_rows(times, recording.scans.stamps.size(), recording.scans.files.size());
  const fs::path poses = child(folder, "aeva_poses.txt");
  if (poses.empty()) {
    return recording;
  }
  const auto pose_lines = formats::read_lines(poses);
  check_rows(poses, pose_lines.size(), recording.scans.files.size());
  for (std::size_t i = 0; i < pose_lines.size(); ++i) {
    const auto& [place, line] = pose_lines[i];
    recording.truth.poses.push_back({recording.scans.stamps[i], rigid_transform(numbers_in(line, place), place)});
  }
  recording.truth = {near_origin(std::move(recording.truth.poses)), poses};
  return recording;
}

}  // namespace

std::vector<Stamp> read_boreas_times(const fs::path& path) {
  std::vector<Stamp> stamps;
  for (const auto& [place, line] : formats::read_lines(path)) {
    const std::vector<std::string_view> words = formats::words_of(line);
    const std::optional<Stamp> stamp = parse_seconds(words.front());
    if (words.size() != 1 || !stamp) {
      throw DataError(fmt::format("{}: is {}, expected one time in seconds", place, formats::quoted_text(line)));
    }
    if (!stamps.empty() && *stamp <= stamps.back()) {
      throw DataError(fmt::format("{}: the time {} comes after {}, expected increasing times", place,
                                  format_seconds(*stamp), format_seconds(stamps.back())));
    }
    stamps.push_back(*stamp);
  }
  return stamps;
}

Eigen::Isometry3d read_boreas_matrix(const fs::path& path) {
  std::string text = formats::read_text_file(path);
  std::replace(text.begin(), text.end(), '\n', ' ');
  return rigid_transform(numbers_in(text, path.string()), path.string());
}

fs::path find_boreas(const fs::path& input) { return find_above(input, is_boreas); }

fs::path find_boreas_scans(const fs::path& input) {
  return find_above(
      input, [](const fs::path& folder) { return holds_files(child(folder, "aeva"), ".bin") || holds_frames(folder); });
}

std::unique_ptr<Dataset> open_boreas(const fs::path& folder, const OpenOptions& options) {
  RecordRecording recording =
      holds_files(child(folder, "aeva"), ".bin") ? aeva_recording(folder, options) : frames_recording(folder);
  recording.format = "boreas";
  return make_record_dataset(std::move(recording));
}

}  // namespace dynamic_icp::datasets
