// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/conversion/conversion.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/recording/conversion/column_types.hpp"
#include "dynamic_icp/recording/conversion/mcap_target.hpp"
#include "dynamic_icp/recording/conversion/targets.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/evaluation/association.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"

namespace dynamic_icp::conversion {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kDicpPeriod_ns = 100'000'000;  // what its reader assumes without poses

struct Layout {
  std::string_view name;
  Target target;
  /// Nothing for a layout of one file.
  void (*write_scan)(const fs::path& folder, const std::string& stem, const ScanToWrite& scan, Notes& notes);
};

constexpr std::array<Layout, 5> kLayouts = {{{"dicp", Target::kDicp, write_dicp_scan},
                                             {"npz", Target::kNpz, write_npz_scan},
                                             {"pcd", Target::kPcd, write_pcd_scan},
                                             {"ply", Target::kPly, write_ply_scan},
                                             {"mcap", Target::kMcap, nullptr}}};

const Layout& layout_of(Target target) { return kLayouts[static_cast<std::size_t>(target)]; }

class Converter {
 public:
  Converter(const datasets::Dataset& dataset, const datasets::ScanRange& range, Target target, const fs::path& path,
            const std::function<void()>& progress)
      : dataset_(dataset), range_(range), target_(target), path_(path), progress_(progress) {
    calibration_.T_vehicle_sensor = dataset.T_vehicle_sensor();
  }

  std::vector<std::string> convert() {
    note_what_is_not_of_points();
    // Read twice: a column has one type in all files, the smallest that holds every number of the recording, and no
    // recording fits into memory.
    for (std::size_t i = range_.begin; i < range_.end; ++i) {
      const RawScan scan = dataset_.scan(i);
      types_.add(scan, dataset_.columns(i));
      add_mountings(scan);
      advance();
    }
    if (target_ == Target::kMcap) {
      McapTarget file(path_, dataset_, calibration_);
      for_each_scan([&](std::size_t i, const ScanToWrite& scan) { file.add(dataset_.stamp(i), scan, notes_); });
      file.finish(notes_);
      return notes_.sentences();
    }
    for_each_scan(
        [&](std::size_t i, const ScanToWrite& scan) { layout_of(target_).write_scan(path_, stem(i), scan, notes_); });
    if (calibration_.T_vehicle_sensor || !calibration_.mountings.empty()) {
      formats::write_bytes(path_ / datasets::kCalibrationFile, datasets::calibration_text(calibration_));
    }
    if (target_ == Target::kDicp) {
      write_dicp_poses();
    } else if (!dataset_.ground_truth().empty()) {
      write_poses(dataset_.ground_truth());
    }
    return notes_.sentences();
  }

 private:
  /// Reads and writes.
  void for_each_scan(const std::function<void(std::size_t index, const ScanToWrite& scan)>& write) {
    for (std::size_t i = range_.begin; i < range_.end; ++i) {
      const RawScan scan = dataset_.scan(i);
      const std::vector<datasets::PointColumn> columns = dataset_.columns(i);
      write(i, {scan, columns, types_});
      if (!scan.warning.empty()) {
        notes_.add(scan.warning);
      }
      advance();
    }
  }

  void advance() const {
    if (progress_) {
      progress_();
    }
  }

  [[nodiscard]] std::string stem(std::size_t index) const {
    if (target_ == Target::kDicp) {
      return fmt::format("{:05}", index - range_.begin + 1);
    }
    const std::int64_t ns = dataset_.stamp(index).ns;
    if (ns < 0) {
      throw DataError(fmt::format("{}: is at {} s, expected a time from 0 on: names of files have no sign",
                                  dataset_.scan_file(index).string(), format_seconds(dataset_.stamp(index))));
    }
    return fmt::format("{:019}", ns);
  }

  void note_what_is_not_of_points() {
    const std::string_view name = layout_of(target_).name;
    if (dataset_.doppler_kind() == DopplerKind::kCompensated && target_ != Target::kMcap) {
      notes_.add(fmt::format("that the Doppler is compensated is left out: {} does not say it, the reader must be told",
                             name));
    }
    if (range_.begin < range_.end && dataset_.boxes(range_.begin)) {
      notes_.add(fmt::format("the boxes of objects are left out: {} has no place for them", name));
    }
  }

  void add_mountings(const RawScan& scan) {
    std::vector<Eigen::Isometry3d>& known = calibration_.mountings;
    known = known.empty() ? scan.mountings : known;
    const auto is_same = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
      return a.matrix() == b.matrix();
    };
    if (!scan.mountings.empty() && !std::ranges::equal(scan.mountings, known, is_same)) {
      notes_.add("the mountings of the sensors differ from scan to scan: those of the first are written");
    }
  }

  void write_poses(const formats::Trajectory& poses) const {
    const fs::path path = path_ / "ref_poses.txt";
    formats::write_bytes(path, formats::format_tum(poses, path.string()));
  }

  /// The truth at the stamp of every scan; nothing where a scan has none.
  [[nodiscard]] std::optional<evaluation::Association> truth_of_scans() const {
    if (dataset_.ground_truth().empty()) {
      return std::nullopt;
    }
    formats::Trajectory scans;
    for (std::size_t i = range_.begin; i < range_.end; ++i) {
      scans.push_back({dataset_.stamp(i), Eigen::Isometry3d::Identity()});
    }
    try {
      evaluation::Association truth = evaluation::associate(scans, dataset_.ground_truth());
      return truth.size() == scans.size() ? std::optional(std::move(truth)) : std::nullopt;
    } catch (const DataError&) {
      return std::nullopt;  // no scan has a pose
    }
  }

  /// Poses of the vehicle where the mounting is known: they carry the stamps as well.
  void write_dicp_poses() {
    const std::optional<evaluation::Association> truth = truth_of_scans();
    if (!truth) {
      bool at_the_period = true;
      for (std::size_t i = range_.begin; i < range_.end; ++i) {
        const auto number = static_cast<std::int64_t>(i - range_.begin);
        at_the_period = at_the_period && dataset_.stamp(i).ns == number * kDicpPeriod_ns;
      }
      if (!dataset_.ground_truth().empty()) {
        notes_.add("the ground truth is left out: dicp needs a pose for every scan, and some scans have none");
      }
      if (!at_the_period) {
        notes_.add("the times of the scans are left out: dicp keeps them with the poses of every scan");
      }
      return;
    }
    if (truth->exact_count < truth->size()) {
      notes_.add(fmt::format("{} of {} poses are interpolated: dicp has poses at the times of scans only",
                             truth->size() - truth->exact_count, truth->size()));
    }
    formats::Trajectory poses = truth->reference;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].stamp = dataset_.stamp(range_.begin + i);
    }
    if (calibration_.T_vehicle_sensor) {
      const Eigen::Isometry3d T_sensor_vehicle = calibration_.T_vehicle_sensor->inverse();
      for (formats::StampedPose& pose : poses) {
        pose.T_world_sensor = pose.T_world_sensor * T_sensor_vehicle;
      }
    }
    write_poses(poses);
  }

  const datasets::Dataset& dataset_;
  const datasets::ScanRange range_;
  const Target target_;
  const fs::path& path_;  ///< the folder, or the file of a layout of one
  const std::function<void()>& progress_;
  ColumnTypes types_;
  datasets::Calibration calibration_;
  Notes notes_;
};

}  // namespace

Target find_target(std::string_view name) {
  std::vector<std::string> known;
  for (const Layout& layout : kLayouts) {
    if (layout.name == name) {
      return layout.target;
    }
    known.emplace_back(layout.name);
  }
  throw UsageError(
      fmt::format("cannot convert to '{}'{}; known are: {}", name, did_you_mean(name, known), fmt::join(known, ", ")));
}

std::vector<std::string> convert(const datasets::Dataset& dataset, const datasets::ScanRange& range, Target target,
                                 const fs::path& folder, const std::function<void()>& progress) {
  const fs::path path = target == Target::kMcap ? folder / "recording.mcap" : folder;
  return Converter(dataset, range, target, path, progress).convert();
}

std::vector<std::string> convert_to_mcap(const datasets::Dataset& dataset, const datasets::ScanRange& range,
                                         const fs::path& file, const std::function<void()>& progress) {
  return Converter(dataset, range, Target::kMcap, file, progress).convert();
}

}  // namespace dynamic_icp::conversion
