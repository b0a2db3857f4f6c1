// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/dataset.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

/// Options that a layout looks at itself.
enum Takes : unsigned {
  kTakesFields = 1,   ///< fields and sensors
  kTakesTopics = 2,   ///< topics
  kTakesColumns = 4,  ///< what numbers without names are, and their type
};

/// One row a layout: how it is recognised and how it is opened.
struct Layout {
  std::string_view name;
  std::string_view looks_like;
  fs::path (*find)(const fs::path& input);  ///< the folder to open; empty when the input is not of this layout
  std::unique_ptr<Dataset> (*open)(const fs::path& folder, const OpenOptions& options);
  fs::path (*find_named)(const fs::path& input) = nullptr;  ///< instead of `find` when the user names the layout
  unsigned takes = 0;                                       ///< of the options: Takes
  bool is_last_resort = false;  ///< texts lie beside many recordings: they count where nothing else is found
};

// The first that finds something is taken.
constexpr Layout kLayouts[] = {
    {"dicp", "a folder with point_clouds/*.bin", find_dicp, open_dicp, find_dicp_scans, kTakesColumns},
    {"hercules", "LiDAR/Aeva/*.bin with PR_GT/ or Radar/, or of 2024 and later", find_hercules, open_hercules,
     find_aeva_folder},
    {"helipr", "LiDAR/Aeva/*.bin otherwise", find_helipr, open_helipr, find_aeva_folder},
    {"boreas", "aeva/*.bin with applanix/ or calib/; frames/*.bin with timestamps.txt and aeva_poses.txt", find_boreas,
     open_boreas, find_boreas_scans},
    {"aevascenes", "sequence.json beside pointcloud_compensated/ or pointcloud_raw/", find_aevascenes, open_aevascenes,
     nullptr, kTakesFields},
    {"rosbag", "*.bag of ROS 1", find_rosbag, open_bag, nullptr, kTakesFields | kTakesTopics},
    {"rosbag2", "a folder with metadata.yaml, or *.db3, of ROS 2", find_rosbag2, open_bag, nullptr,
     kTakesFields | kTakesTopics},
    {"mcap", "*.mcap", find_mcap, open_bag, nullptr, kTakesFields | kTakesTopics},
    // What any data set may hold comes last.
    {"npz", "*.npz, *.npy of shape (N, 4) or wider, or <name>.npy with <name>_dop.npy", find_npz, open_npz, nullptr,
     kTakesFields | kTakesColumns},
    {"pcd", "*.pcd", find_pcd, open_pcd, nullptr, kTakesFields},
    {"ply", "*.ply", find_ply, open_ply, nullptr, kTakesFields},
    {"bin", "a folder of *.bin whose record layout is recognised by content", find_bin_folder, open_bin_folder,
     find_bin_scans, kTakesColumns},
    {"csv", "*.csv, *.txt, *.xyz or *.asc, rows of points with or without names", find_csv, open_csv, nullptr,
     kTakesFields | kTakesColumns, true},
};

std::string looked_for() {
  std::string text;
  for (const Layout& layout : kLayouts) {
    text += fmt::format("\n  {}: {}", layout.name, layout.looks_like);
  }
  return text;
}

void check_options_of(const Layout& layout, const OpenOptions& options) {
  if ((layout.takes & kTakesFields) == 0 && !(options.fields.empty() && options.sensors.empty())) {
    throw UsageError(
        fmt::format("{} has neither columns with names nor several sensors to choose from; '{}' was asked for",
                    layout.name, options.fields.empty() ? options.sensors.front() : options.fields.begin()->first));
  }
  if ((layout.takes & kTakesTopics) == 0 && !(options.topics.empty() && options.truth_topic.empty())) {
    throw UsageError(fmt::format("{} has no topics to choose from, as bags have; '{}' was asked for", layout.name,
                                 options.topics.empty() ? options.truth_topic : options.topics.front()));
  }
  const std::vector<std::string> in_order = {"x", "y", "z", "doppler"};
  if ((layout.takes & kTakesColumns) == 0 &&
      !(options.dtype.empty() && (options.columns.empty() || options.columns == in_order))) {
    throw UsageError(
        fmt::format("{} says itself what its numbers are: columns may put x, y, z and doppler into another "
                    "order, not name others, and there is no type to choose",
                    layout.name));
  }
}

/// Whether a path is the other one or lies in it.
bool lies_in(const fs::path& path, const fs::path& folder) {
  const fs::path below =
      fs::absolute(path).lexically_normal().lexically_relative(fs::absolute(folder).lexically_normal());
  return !below.empty() && *below.begin() != "..";
}

/// What the layout finds. One that finds several folders throws, which counts for the first layout only: within a
/// recording of another layout they mean nothing.
fs::path find_or_nothing(const Layout& layout, const fs::path& input, bool is_first) {
  try {
    return layout.find(input);
  } catch (const DataError&) {
    if (is_first) {
      throw;
    }
    return {};
  }
}

/// A layout and the folder to open.
struct Match {
  const Layout* layout = nullptr;  ///< null: none
  fs::path folder;
};

/// The first layout that finds something. Throws DataError when that lies below the input and another layout finds
/// something beside it: which one is meant is not for us to choose. What lies in a recording is part of it.
Match match_any(const fs::path& input) {
  Match match;
  for (const Layout& layout : kLayouts) {
    if (layout.is_last_resort && match.layout != nullptr) {
      break;
    }
    fs::path found = find_or_nothing(layout, input, match.layout == nullptr);
    if (found.empty()) {
      continue;
    }
    if (match.layout == nullptr) {
      match = {&layout, std::move(found)};
      if (lies_in(input, match.folder)) {
        return match;
      }
    } else if (!lies_in(found, match.folder) && !lies_in(match.folder, found)) {
      throw NotARecording(fmt::format("{}: holds several recordings, name one of them:\n  {} ({})\n  {} ({})",
                                      input.string(), match.folder.string(), match.layout->name, found.string(),
                                      layout.name));
    }
  }
  return match;
}

/// What the layout of that name finds. Throws UsageError when there is no such layout.
Match match_named(const fs::path& input, const std::string& format) {
  for (const Layout& layout : kLayouts) {
    if (layout.name == format) {
      fs::path found = (layout.find_named != nullptr ? layout.find_named : layout.find)(input);
      return found.empty() ? Match{} : Match{&layout, std::move(found)};
    }
  }
  std::vector<std::string> known = {"auto"};
  for (const Layout& layout : kLayouts) {
    known.emplace_back(layout.name);
  }
  throw UsageError(
      fmt::format("unknown format '{}'{}; known are: auto{}", format, did_you_mean(format, known), looked_for()));
}

/// The folder of an input, or of the file that it is.
fs::path folder_of(const fs::path& input) {
  const fs::path whole = named_path(input);
  std::error_code fault;
  return fs::is_directory(whole, fault) ? whole : whole.parent_path();
}

bool is_times_folder(const fs::path& input) { return same_name(folder_of(input), "times"); }

/// Throws NotARecording for what is no recording itself, but lies in a folder of one with folders of its own: the times
/// of points, labels, poses.
void refuse_part_of_recording(const fs::path& input) {
  constexpr std::string_view kWithFolders[] = {"dicp", "hercules", "helipr", "boreas", "aevascenes"};
  const fs::path folder = folder_of(input).parent_path();
  for (const Layout& layout : kLayouts) {
    if (std::ranges::find(kWithFolders, layout.name) != std::end(kWithFolders) &&
        find_or_nothing(layout, folder, false) == folder) {
      throw NotARecording(fmt::format("{}: is a part of the recording {} ({}), not one itself: name that folder",
                                      input.string(), folder.string(), layout.name));
    }
  }
}

/// The layout of the input and what to open. Throws NotARecording where it is of none.
Match match_of(const fs::path& input, const OpenOptions& options) {
  std::error_code fault;
  const fs::file_status status = fs::status(input, fault);
  if (input == "-") {
    throw DataError("standard input cannot be read twice: it can only be followed");
  }
  if (status.type() == fs::file_type::not_found) {
    throw DataError(fmt::format("{}: no such file or folder", input.empty() ? "''" : input.string()));
  }
  if (fault) {  // a link to itself, a folder that must not be entered
    throw DataError(fmt::format("{}: cannot be opened: {}", input.string(), fault.message()));
  }
  formats::refuse_irregular(input);
  const Match match = options.format == "auto" ? match_any(input) : match_named(input, options.format);
  if (match.layout != nullptr) {
    return match;
  }
  if (const std::string obstacle = known_obstacle(input); !obstacle.empty()) {
    throw NotARecording(obstacle);
  }
  refuse_part_of_recording(input);
  throw NotARecording(fmt::format("{}: not a recording of a known layout{}. Looked for:{}", input.string(),
                                  what_is_there(input), looked_for()));
}

}  // namespace

FoundDataset find_dataset(const fs::path& input, const OpenOptions& options) {
  Match match = match_of(input, options);
  return {std::string(match.layout->name), std::move(match.folder)};
}

std::unique_ptr<Dataset> open_dataset(const fs::path& input, const OpenOptions& options) {
  const Match match = match_of(input, options);
  check_options_of(*match.layout, options);
  const bool is_guessed = match.layout->name == "bin" && options.format == "auto" && options.columns.empty();
  if (is_guessed && is_times_folder(input)) {
    refuse_part_of_recording(input);  // times of points look like records of anything
  }
  try {
    return match.layout->open(match.folder, options);
  } catch (const DataError&) {
    if (is_guessed) {
      refuse_part_of_recording(input);
    }
    throw;
  }
}

void check_options(std::string_view format, const OpenOptions& options) {
  for (const Layout& layout : kLayouts) {
    if (layout.name == format) {
      check_options_of(layout, options);
    }
  }
}

std::vector<std::string> known_formats() {
  std::vector<std::string> names;
  for (const Layout& layout : kLayouts) {
    names.emplace_back(layout.name);
  }
  return names;
}

}  // namespace dynamic_icp::datasets
