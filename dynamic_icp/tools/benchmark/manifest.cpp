// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/manifest.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/formats/yaml_map.hpp"
#include "dynamic_icp/tools/benchmark/benchmark_folder.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 5;

/// The parts of a path as they are compared.
std::vector<std::string> comparable_parts(const fs::path& path) {
  std::vector<std::string> parts;
  for (const fs::path& part : path) {
    std::string text;
    for (const char c : part.string()) {
      if (c != ' ' && c != '-' && c != '_') {
        text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      }
    }
    if (!text.empty()) {
      parts.push_back(text);
    }
  }
  return parts;
}

bool ends_with(const std::vector<std::string>& parts, const std::vector<std::string>& end) {
  return parts.size() >= end.size() && std::equal(end.rbegin(), end.rend(), parts.rbegin());
}

/// A folder, and the parts of its path from the root on as they are compared.
struct Folder {
  fs::path path;
  std::vector<std::string> parts;
};

/// All folders to look at, those nearer to the root first. The name of the root may be a part of what is asked for.
std::vector<Folder> folders_below(const fs::path& root) {
  std::vector<fs::path> level = {root};
  std::vector<Folder> all;
  for (int depth = 0; depth <= kDeepest && !level.empty(); ++depth) {
    std::vector<fs::path> below;
    for (const fs::path& folder : level) {
      all.push_back({folder, comparable_parts(folder.lexically_relative(root.parent_path()))});
      const std::vector<fs::path> inner = datasets::entries_of(folder, datasets::is_visible_folder);
      below.insert(below.end(), inner.begin(), inner.end());
    }
    level = std::move(below);
  }
  return all;
}

/// The first folder whose path ends as one of the entry does; empty when there is none.
fs::path find(const ManifestEntry& entry, const std::vector<Folder>& folders) {
  for (const std::string& wanted : entry.folders) {
    const std::vector<std::string> end = comparable_parts(wanted);
    const auto found = std::find_if(folders.begin(), folders.end(),
                                    [&](const Folder& folder) { return ends_with(folder.parts, end); });
    if (found != folders.end()) {
      return found->path;
    }
  }
  return {};
}

}  // namespace

Manifest read_manifest(const fs::path& path) {
  const formats::YamlMap file = formats::YamlMap::load(path);
  Manifest manifest;
  manifest.description = file.text("description");
  manifest.format = file.text("format");
  if (file.has("lidars")) {
    manifest.lidars = file.texts("lidars");
  }
  std::set<std::string> names;
  for (const formats::YamlMap& map : file.list("sequences")) {
    ManifestEntry entry{map.text("name"), map.texts("folders")};
    if (const std::string fault = unfit_name(entry.name); !fault.empty()) {
      map.fail("name", fmt::format("{}, expected a name that can be that of a folder of runs", fault));
    }
    for (const std::string& folder : entry.folders) {
      if (without_control_characters(folder) != folder) {
        map.fail("folders", "holds a control character, expected ends of paths");
      }
    }
    if (!names.insert(entry.name).second) {
      map.fail("name", fmt::format("is '{}' for the second time", entry.name));
    }
    manifest.sequences.push_back(std::move(entry));
  }
  if (manifest.sequences.empty()) {
    file.fail("sequences", "is missing or empty, expected a list of name and folders");
  }
  file.finish();
  return manifest;
}

void apply(const Manifest& manifest, datasets::InputSettings& settings) {
  settings.open.format = manifest.format;
  if (!manifest.lidars.empty()) {
    settings.open.sensors = manifest.lidars;
  }
}

Sequences open_manifest(const Manifest& manifest, const fs::path& root, const datasets::InputSettings& settings,
                        const fs::path& output) {
  if (!fs::is_directory(root)) {
    throw DataError(fmt::format("{}: no such folder; expected the one that holds the recordings", root.string()));
  }
  const std::vector<Folder> folders = folders_below(fs::canonical(root));
  Sequences opened;
  for (const ManifestEntry& entry : manifest.sequences) {
    const fs::path folder = find(entry, folders);
    if (folder.empty()) {
      opened.skipped.push_back(
          {fmt::format("{}: no folder '{}' below {}", entry.name, fmt::join(entry.folders, "' or '"), root.string()),
           {}});
      continue;
    }
    try {
      opened.sequences.push_back(open_sequence(folder, settings, output));
      opened.sequences.back().label = entry.name;
    } catch (const datasets::UnclearInput& error) {
      opened.skipped.push_back({fmt::format("{}: {}", entry.name, error.what()), error.proposal()});
    } catch (const DataError& error) {
      opened.skipped.push_back({fmt::format("{}: {}", entry.name, error.what()), {}});
    }
  }
  if (opened.sequences.empty()) {
    refuse_all(
        fmt::format("{}: none of the {} recordings of the manifest is there", root.string(), manifest.sequences.size()),
        opened.skipped);
  }
  return opened;
}

}  // namespace dynamic_icp::benchmark
