// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_context.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"
#include "dynamic_icp/recording/evaluation/association.hpp"
#include "dynamic_icp/recording/evaluation/consistency.hpp"
#include "dynamic_icp/recording/evaluation/relative_error.hpp"

namespace dynamic_icp::figures {
namespace {

using formats::Trajectory;

constexpr double kMaxStretch_m = 1e6;

/// What was said about the recording when it was run.
datasets::InputSettings input_settings(const runs::RunFiles& run) {
  constexpr std::string_view kOptions = "input.options.";
  datasets::InputSettings settings;
  if (const std::string format = runs::text_of(run.run, "input.format"); !format.empty()) {
    settings.open.format = format;
  }
  for (const auto& [key, value] : run.run) {
    if (key.starts_with(kOptions)) {
      datasets::set(settings, key.substr(kOptions.size()), runs::text_of(run.run, key));
    }
  }
  return settings;
}

Trajectory truth_trajectory(const std::string& path, const datasets::Dataset* recording, const Trajectory& estimate) {
  if (recording != nullptr && recording->ground_truth_file() == path) {
    return recording->ground_truth();
  }
  return datasets::read_truth(path,
                              recording != nullptr ? datasets::stamps_of(*recording) : datasets::stamps_of(estimate));
}

/// Speeds from the differences of the positions before and after; frames whose neighbours are unmatched get none.
std::vector<double> true_speeds(const evaluation::Association& matched, std::size_t frames) {
  std::vector<double> speeds(frames, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < matched.size(); ++k) {
    const std::size_t before = k == 0 ? 0 : k - 1;
    const std::size_t after = k + 1 == matched.size() ? k : k + 1;
    const std::vector<std::size_t>& index = matched.estimate_indices;
    if (after > before && index[after] - index[before] == after - before) {
      const formats::StampedPose& from = matched.reference[before];
      const formats::StampedPose& to = matched.reference[after];
      const double distance = (to.T_world_sensor.translation() - from.T_world_sensor.translation()).norm();
      speeds[index[k]] = distance / seconds_between(from.stamp, to.stamp);
    }
  }
  return speeds;
}

/// 1, 2, 5, 10, ... m up to the length of the ground truth.
std::vector<double> stretch_lengths(const evaluation::Association& matched) {
  const double whole_m = matched.size() > 0 ? evaluation::path_distances(matched.reference).back() : 0.0;
  std::vector<double> lengths;
  for (double decade = 1.0; decade <= std::min(whole_m, kMaxStretch_m); decade *= 10.0) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor * decade <= whole_m) {
        lengths.push_back(factor * decade);
      }
    }
  }
  return lengths;
}

std::vector<StretchError> stretch_errors(const evaluation::Association& matched) {
  std::vector<StretchError> errors;
  for (const double length : stretch_lengths(matched)) {
    const evaluation::RelativeError error =
        evaluation::relative_error(matched, {.unit = evaluation::GapUnit::kMeters, .length = length});
    if (error.translation_m && error.rotation_deg) {
      errors.push_back({length, error.steps.size(), error.translation_m->rmse, error.rotation_deg->rmse});
    }
  }
  return errors;
}

void add_consistency(const runs::RunFiles& run, const evaluation::Association& matched, RunTruth& truth) {
  truth.nees_rotation.assign(run.frames.size(), std::numeric_limits<double>::quiet_NaN());
  truth.nees_translation = truth.nees_rotation;
  std::vector<evaluation::StatedMotion> stated;
  std::transform(run.frames.begin(), run.frames.end(), std::back_inserter(stated), runs::stated_motion);
  for (const evaluation::MotionConsistency& motion : evaluation::motion_consistency(matched, stated)) {
    truth.nees_rotation[motion.frame] = motion.nees_rotation.value_or(std::numeric_limits<double>::quiet_NaN());
    truth.nees_translation[motion.frame] = motion.nees_translation.value_or(std::numeric_limits<double>::quiet_NaN());
  }
}

RunTruth compare(const runs::RunFiles& run, const Trajectory& reference) {
  const evaluation::Association matched = evaluation::associate(run.trajectory, reference);
  RunTruth truth;
  const Eigen::Isometry3d T_estimate_reference =
      matched.estimate.front().T_world_sensor * matched.reference.front().T_world_sensor.inverse();
  truth.poses.resize(run.frames.size());
  for (std::size_t k = 0; k < matched.size(); ++k) {
    truth.poses[matched.estimate_indices[k]] = T_estimate_reference * matched.reference[k].T_world_sensor;
  }
  truth.speed = true_speeds(matched, run.frames.size());
  truth.translation_error.assign(run.frames.size(), std::numeric_limits<double>::quiet_NaN());
  truth.rotation_error = truth.translation_error;
  for (const evaluation::RelativeStep& step : evaluation::relative_error(matched).steps) {
    truth.translation_error[matched.estimate_indices[step.to]] = step.error.translation_m;
    truth.rotation_error[matched.estimate_indices[step.to]] = step.error.rotation_deg;
  }
  truth.stretches = stretch_errors(matched);
  add_consistency(run, matched, truth);
  return truth;
}

ScanView view_scan(const runs::RunFiles& run, const datasets::Dataset& recording, std::size_t frame) {
  const RawScan raw = read_scan(run, recording, frame);
  ScanView view;
  view.title = fmt::format("Scan {}", run.frames[frame].index);
  view.scan = Scan::from_raw(raw);
  view.ego_velocity = run.frames[frame].ego_velocity;
  view.objects = run.objects[frame];
  view.labels = runs::read_labels(run, frame, raw.points.size()).value_or(std::vector<std::int32_t>());
  return view;
}

}  // namespace

std::unique_ptr<datasets::Dataset> open_recording(const runs::RunFiles& run, std::vector<std::string>& notes) {
  constexpr const char* kNote = "No scans are shown: the recording cannot be opened. {}";
  try {
    return datasets::open_input(runs::text_of(run.run, "input.path"), input_settings(run));
  } catch (const std::runtime_error& error) {
    notes.push_back(fmt::format(kNote, error.what()));
  } catch (const UsageError& error) {
    notes.push_back(fmt::format(kNote, error.what()));
  }
  return nullptr;
}

std::optional<RunTruth> read_truth(const runs::RunFiles& run, const datasets::Dataset* recording,
                                   std::vector<std::string>& notes) {
  const std::string path = runs::text_of(run.run, "ground_truth");
  if (path.empty()) {
    notes.emplace_back("No errors are shown: the run has no ground truth.");
    return std::nullopt;
  }
  try {
    return compare(run, truth_trajectory(path, recording, run.trajectory));
  } catch (const DataError& error) {
    notes.push_back(fmt::format("No errors are shown: the ground truth cannot be used. {}", error.what()));
    return std::nullopt;
  }
}

RawScan read_scan(const runs::RunFiles& run, const datasets::Dataset& recording, std::size_t frame) {
  const runs::FrameRow& row = run.frames[frame];
  if (row.index >= recording.size()) {
    throw DataError(fmt::format("The recording holds {} scans, the run saw number {}.", recording.size(), row.index));
  }
  RawScan raw = recording.scan(row.index);
  if (static_cast<double>(raw.points.size()) != row.points) {
    throw DataError(fmt::format("{}: {} points, the run saw {}: the recording has changed.",
                                recording.scan_file(row.index).string(), raw.points.size(), row.points));
  }
  return raw;
}

std::size_t frame_with_most_object_points(const runs::RunFiles& run) {
  std::size_t best = 0;
  double most = -1.0;
  for (std::size_t k = 0; k < run.objects.size(); ++k) {
    double points = 0.0;
    for (const runs::ObjectRow& object : run.objects[k]) {
      points += object.points;
    }
    if (points > most) {
      most = points;
      best = k;
    }
  }
  return best;
}

RunContext read_context(const runs::RunFiles& run, std::optional<std::size_t> frame) {
  if (frame && *frame >= run.frames.size()) {
    throw UsageError(
        fmt::format("scan {} is asked for, expected 0 to {}", *frame, std::max<std::size_t>(run.frames.size(), 1) - 1));
  }
  RunContext context;
  if (run.frames.empty()) {
    context.notes.emplace_back("The run holds no scans.");
    return context;
  }
  const std::unique_ptr<datasets::Dataset> recording = open_recording(run, context.notes);
  context.truth = read_truth(run, recording.get(), context.notes);
  if (recording != nullptr) {
    try {
      context.scan = view_scan(run, *recording, frame.value_or(frame_with_most_object_points(run)));
    } catch (const DataError& error) {
      context.notes.push_back(fmt::format("The scan is not shown. {}", error.what()));
    }
  }
  return context;
}

}  // namespace dynamic_icp::figures
