// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/input_settings.hpp"
#include "dynamic_icp/recording/datasets/pose_file.hpp"
#include "dynamic_icp/recording/evaluation/evaluation.hpp"
#include "dynamic_icp/recording/evaluation/evaluation_report.hpp"
#include "dynamic_icp/recording/evaluation/object_tracking_report.hpp"
#include "dynamic_icp/recording/formats/kitti_write.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/runs/frame_rows.hpp"
#include "dynamic_icp/recording/runs/object_comparison.hpp"

#include "apps/commands.hpp"
#include "apps/messages.hpp"
#include "apps/options.hpp"

namespace dynamic_icp::apps {
namespace {

struct Options {
  std::string estimate;
  std::string reference;
  std::string alignment = "se3";
  std::optional<int> gap_frames;
  std::optional<double> gap_seconds;
  std::optional<double> gap_meters;
  evaluation::AssociationConfig association;
  std::optional<std::filesystem::path> kitti;
  std::optional<std::filesystem::path> kitti_reference;
  bool objects = false;
  bool json = false;
};

evaluation::Alignment alignment_of(const std::string& name) {
  using evaluation::Alignment;
  for (const Alignment alignment : {Alignment::kNone, Alignment::kFirst, Alignment::kSe3, Alignment::kSim3}) {
    if (name == evaluation::alignment_name(alignment)) {
      return alignment;
    }
  }
  throw UsageError(fmt::format("--align is '{}', expected none, first, se3 or sim3", name));
}

evaluation::EvaluationConfig config_of(const Options& options) {
  evaluation::EvaluationConfig config;
  config.association = options.association;
  config.alignment = alignment_of(options.alignment);
  if (options.gap_frames) {
    config.gap = {evaluation::GapUnit::kFrames, static_cast<double>(*options.gap_frames)};
  } else if (options.gap_seconds) {
    config.gap = {evaluation::GapUnit::kSeconds, *options.gap_seconds};
  } else if (options.gap_meters) {
    config.gap = {evaluation::GapUnit::kMeters, *options.gap_meters};
  }
  evaluation::check_config(config);
  return config;
}

/// What the run states of the poses of its trajectory.tum, from the frames.jsonl beside it. Empty for other files.
std::vector<evaluation::StatedMotion> stated_beside(const std::filesystem::path& estimate, std::size_t poses) {
  const std::filesystem::path file = estimate.parent_path() / "frames.jsonl";
  std::vector<evaluation::StatedMotion> stated;
  if (estimate.filename() != "trajectory.tum" || !std::filesystem::exists(file)) {
    return stated;
  }
  for (const runs::FrameRow& frame : runs::read_frames(file)) {
    stated.push_back(runs::stated_motion(frame));
  }
  if (stated.size() != poses) {
    tell("dynamic-icp: warning: {} holds {} scans, {} {} poses: no covariances are compared\n", file.string(),
         stated.size(), estimate.string(), poses);
    stated.clear();
  }
  return stated;
}

/// The evaluation of two files; errors that do not name a file yet get both.
evaluation::Evaluation evaluate_files(const Options& options, const evaluation::EvaluationConfig& config,
                                      const formats::TumFile& estimate, const formats::TumFile& reference) {
  try {
    return evaluation::evaluate(estimate.trajectory, reference.trajectory, config,
                                stated_beside(options.estimate, estimate.trajectory.size()));
  } catch (const DataError& error) {
    throw DataError(fmt::format("{} against {}: {}", options.estimate, options.reference, error.what()));
  }
}

void write_out(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw DataError(fmt::format("standard output: cannot write: {}", std::strerror(errno)));
  }
}

/// The poses that were compared, row by row the same scans, for the tools of KITTI.
void write_kitti_files(const Options& options, const formats::TumFile& estimate, const formats::TumFile& reference) {
  if (!options.kitti && !options.kitti_reference) {
    return;
  }
  const evaluation::Association matched =
      evaluation::associate(estimate.trajectory, reference.trajectory, options.association);
  if (options.kitti) {
    formats::write_kitti(*options.kitti, matched.estimate);
  }
  if (options.kitti_reference) {
    formats::write_kitti(*options.kitti_reference, matched.reference);
  }
}

/// Of a folder of a run its trajectory; other names are those of files.
std::filesystem::path trajectory_file(const std::filesystem::path& named) {
  const std::filesystem::path in_folder = named / "trajectory.tum";
  return std::filesystem::exists(in_folder) ? in_folder : named;
}

formats::TumFile read_estimate(const std::string& file) {
  datasets::PoseFile poses = datasets::read_pose_file(file);
  if (!poses.has_stamps) {
    throw DataError(
        fmt::format("{}: its poses have no times, expected those of a run (trajectory.tum), or a times.txt "
                    "beside it with as many times",
                    file));
  }
  return {std::move(poses.poses), poses.repeated_lines};
}

/// The reference: a file, the trajectory of another run, or the ground truth that a recording brings along. Poses
/// without times are those of the estimate, one for one.
formats::TumFile read_reference(std::filesystem::path& named, const formats::Trajectory& estimate) {
  named = trajectory_file(named);
  if (!std::filesystem::is_directory(named)) {
    datasets::PoseFile poses = datasets::read_pose_file(named);
    return poses.has_stamps ? formats::TumFile{std::move(poses.poses), poses.repeated_lines}
                            : formats::TumFile{datasets::read_truth(named, datasets::stamps_of(estimate)), 0};
  }
  const std::unique_ptr<datasets::Dataset> recording = datasets::open_input(named, {});
  if (recording->ground_truth().empty()) {
    throw DataError(
        fmt::format("{}: is a recording without ground truth; name the file that holds it", named.string()));
  }
  named = recording->ground_truth_file();
  return {recording->ground_truth(), 0};
}

int evaluate_objects(const Options& options) {
  const evaluation::ObjectTracking tracking = runs::compare_run_objects(options.estimate, options.reference);
  write_out(options.json ? evaluation::tracking_json(tracking) : evaluation::tracking_table(tracking));
  return 0;
}

int run_evaluate(Options options) {
  if (options.objects) {
    return evaluate_objects(options);
  }
  const evaluation::EvaluationConfig config = config_of(options);  // wrong use is reported before a file is read
  options.estimate = trajectory_file(options.estimate).string();
  const formats::TumFile estimate = read_estimate(options.estimate);
  std::filesystem::path reference_file = options.reference;
  const formats::TumFile reference = read_reference(reference_file, estimate.trajectory);
  options.reference = reference_file.string();
  const evaluation::Evaluation evaluation = evaluate_files(options, config, estimate, reference);
  const evaluation::EvaluationSource source = {options.estimate, options.reference, estimate.repeated_lines,
                                               reference.repeated_lines};
  const std::string text =
      options.json ? evaluation::evaluation_json(evaluation, source) : evaluation::evaluation_table(evaluation, source);
  write_kitti_files(options, estimate, reference);
  write_out(text);
  return 0;
}

void add_error_options(CLI::App& command, Options& options) {
  add_option(command, "--align", options.alignment, "KIND",
             fmt::format("what the estimate is moved by before absolute errors: none; first (first poses made "
                         "equal); se3 (best rigid motion); sim3 (with scale); default {}",
                         options.alignment));
  CLI::Option* frames = add_option(
      command, "--gap-frames", options.gap_frames, "N",
      fmt::format("relative errors over so many matched poses; default {:g}", evaluation::RelativeGap{}.length));
  CLI::Option* seconds =
      add_option(command, "--gap-seconds", options.gap_seconds, "S", "relative errors over so many seconds instead");
  add_option(command, "--gap-meters", options.gap_meters, "M",
             "relative errors over so many metres of the reference instead")
      ->excludes(frames)
      ->excludes(seconds);
  seconds->excludes(frames);
  add_option(command, "--max-gap", options.association.max_gap_s, "S",
             fmt::format("the reference is interpolated between poses at most so many seconds apart; default {:g}",
                         options.association.max_gap_s));
  add_option(command, "--save-kitti", options.kitti, "FILE",
             "write the poses of the estimate that have a reference as KITTI has them: 12 numbers a line, "
             "T_world_sensor row by row");
  add_option(command, "--save-kitti-reference", options.kitti_reference, "FILE",
             "the same of the reference, line by line at the same times");
}

}  // namespace

void add_evaluate_command(CLI::App& app, std::function<int()>& selected) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Compare an estimated trajectory, or its moving objects, with a reference");
  command
      ->add_option("ESTIMATE", options->estimate,
                   "TUM file: timestamp tx ty tz qx qy qz qw (s, m, unit quaternion); of the trajectory.tum of a "
                   "run the covariances of frames.jsonl beside it are compared too; or the folder of a run")
      ->required();
  command
      ->add_option(
          "REFERENCE", options->reference,
          "True poses of the same sensor: TUM, KITTI (12 columns, one pose for each of ESTIMATE, or a times.txt beside "
          "them) or CSV with a header; or a recording with ground truth, with --objects a simulated one; or the folder "
          "of another run")
      ->required();
  add_error_options(*command, *options);
  CLI::Option* objects = command->add_flag("--objects", options->objects,
                                           "compare the moving objects instead (objects.jsonl of both): HOTA, MOTA, "
                                           "IDF1, errors of velocity, box, heading and prediction; what labels say of "
                                           "points where there are any");
  for (const char* of_poses : {"--align", "--gap-frames", "--gap-seconds", "--gap-meters", "--max-gap", "--save-kitti",
                               "--save-kitti-reference"}) {
    objects->excludes(of_poses);
  }
  command->add_flag("--json", options->json, "print one JSON object with all numbers instead of the table");
  command->callback([options, &selected] { selected = [options] { return run_evaluate(*options); }; });
}

}  // namespace dynamic_icp::apps
