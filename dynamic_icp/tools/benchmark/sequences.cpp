// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/sequences.hpp"

#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"
#include "dynamic_icp/tools/benchmark/content_checksum.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

fs::path object_truth_of(const fs::path& path, const datasets::Dataset& dataset) {
  for (const fs::path& folder : {dataset.ground_truth_file().parent_path(), path}) {
    std::error_code ignored;
    if (!folder.empty() && fs::is_regular_file(folder / "objects.jsonl", ignored)) {
      return folder / "objects.jsonl";
    }
  }
  return {};
}

/// The recordings among the sub-folders of a folder that is none. Throws DataError that says what is wrong with them
/// where all are damaged; false when there is none at all.
bool append_folders(Sequences& into, const fs::path& path, const datasets::InputSettings& settings,
                    const fs::path& output) {
  const std::size_t before = into.sequences.size();
  std::vector<Skipped> skipped;
  std::vector<Skipped> damaged;
  for (const fs::path& folder : datasets::entries_of(path, datasets::is_visible_folder)) {
    try {
      if (folder != output) {
        into.sequences.push_back(open_sequence(folder, settings, output));
      }
    } catch (const datasets::NotARecording& error) {
      skipped.push_back({error.what(), {}});
    } catch (const datasets::UnclearInput& error) {
      damaged.push_back({error.what(), error.proposal()});
    } catch (const DataError& error) {
      damaged.push_back({error.what(), {}});
    }
  }
  const bool found = into.sequences.size() > before;
  if (!found && !damaged.empty()) {
    refuse_all(fmt::format("{}: none of the recordings in it can be read", path.string()), damaged);
  }
  if (found) {
    into.skipped.insert(into.skipped.end(), damaged.begin(), damaged.end());
    into.skipped.insert(into.skipped.end(), skipped.begin(), skipped.end());
  }
  return found;
}

/// A damaged recording is not taken apart: its sub-folders may look like recordings, of what are times in truth.
void append_input(Sequences& into, const fs::path& path, const datasets::InputSettings& settings,
                  const fs::path& output) {
  try {
    into.sequences.push_back(open_sequence(path, settings, output));
  } catch (const datasets::NotARecording&) {
    if (!append_folders(into, path, settings, output)) {
      throw;
    }
  }
}

/// The folder of the recording where the input is that of its scans alone: more of it lies beside them.
fs::path whole_recording(const fs::path& path) {
  const fs::path name = path.filename();
  const bool scans_themselves = name == "point_clouds" || name == "pointcloud_raw" || name == "pointcloud_compensated";
  return scans_themselves && path.has_parent_path() ? path.parent_path() : path;
}

/// A name that no terminal and no table takes for a command.
std::string name_of(const fs::path& path) {
  return without_control_characters(whole_recording(path).filename().string());
}

/// Of everything that runs read: the files of the recording, and what it says of stamps, truth and mounting, which may
/// come from files beside it.
std::string recording_checksum(const fs::path& path, const datasets::Dataset& dataset, const fs::path& object_truth,
                               const fs::path& output) {
  Checksum checksum;
  checksum.add(content_checksum(whole_recording(path), output));
  for (std::size_t i = 0; i < dataset.size(); ++i) {
    checksum.add(format_seconds(dataset.stamp(i)));
  }
  for (const formats::StampedPose& pose : dataset.ground_truth()) {
    checksum.add(format_seconds(pose.stamp));
    checksum.add(std::span(pose.T_world_sensor.data(), 16));
  }
  if (const std::optional<Eigen::Isometry3d> T_vehicle_sensor = dataset.T_vehicle_sensor()) {
    checksum.add(std::span(T_vehicle_sensor->data(), 16));
  }
  if (!object_truth.empty()) {
    checksum.add_file(object_truth);
  }
  return checksum.text();
}

void label_sequences(std::vector<Sequence>& sequences) {
  std::set<std::string> taken = {""};
  std::multiset<std::string> names;
  for (const Sequence& sequence : sequences) {
    names.insert(name_of(sequence.path));
  }
  for (Sequence& sequence : sequences) {
    const std::string name = name_of(sequence.path);
    const std::string parent = without_control_characters(sequence.path.parent_path().filename().string());
    const std::string wanted = names.count(name) > 1 && !parent.empty() ? parent + "_" + name : name;
    sequence.label = wanted;
    for (int number = 2; is_own_name(sequence.label) || !taken.insert(sequence.label).second; ++number) {
      sequence.label = fmt::format("{}_{}", wanted, number);
    }
  }
}

}  // namespace

void refuse_all(const std::string& what, const std::vector<Skipped>& skipped) {
  std::string text = what + ":";
  datasets::UnclearInput::Settings proposal;
  for (const Skipped& one : skipped) {
    text += "\n  " + one.reason;
    proposal = proposal.empty() ? one.proposal : proposal;
  }
  if (proposal.empty()) {
    throw DataError(text);
  }
  throw datasets::UnclearInput(text, std::move(proposal));
}

Sequence open_sequence(const fs::path& path, const datasets::InputSettings& settings, const fs::path& output) {
  const std::unique_ptr<datasets::Dataset> dataset = datasets::open_input(path, settings);
  if (dataset->size() == 0) {
    throw DataError(fmt::format("{}: holds no scans", path.string()));
  }
  Sequence sequence;
  sequence.path = path;
  sequence.scans = dataset->size();
  sequence.first_stamp = dataset->stamp(0);
  sequence.last_stamp = dataset->stamp(dataset->size() - 1);
  sequence.object_truth = object_truth_of(path, *dataset);
  sequence.bytes = content_bytes(whole_recording(path), output);
  sequence.content = recording_checksum(path, *dataset, sequence.object_truth, output);
  return sequence;
}

Sequences open_sequences(const std::vector<std::string>& inputs, const datasets::InputSettings& settings,
                         const fs::path& output) {
  Sequences opened;
  for (const std::string& input : inputs) {
    append_input(opened, datasets::named_path(input), settings, datasets::named_path(output));
  }
  std::set<fs::path> seen;
  for (const Sequence& sequence : opened.sequences) {
    if (!seen.insert(fs::weakly_canonical(sequence.path)).second) {
      throw UsageError(fmt::format("{}: given twice", sequence.path.string()));
    }
  }
  label_sequences(opened.sequences);
  return opened;
}

}  // namespace dynamic_icp::benchmark
