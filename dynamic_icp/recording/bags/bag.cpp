// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/bag.hpp"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag_files.hpp"
#include "dynamic_icp/recording/bags/joined_bag.hpp"

namespace dynamic_icp::bags {
namespace {

namespace fs = std::filesystem;

constexpr int kBagSearchDepth = 3;

struct Folder {
  std::vector<fs::path> bags;  ///< by their names
  std::vector<fs::path> folders;
};

/// Nothing where it cannot be read. Links to folders are left out: they may lead round in circles.
Folder look_into(const fs::path& path) {
  Folder folder;
  std::error_code fault;
  for (fs::directory_iterator entry(path, fault); !fault && entry != fs::directory_iterator(); entry.increment(fault)) {
    std::error_code ignored;
    if (entry->path().filename().string().front() == '.') {
      continue;
    }
    if (entry->is_directory(ignored)) {
      if (!entry->is_symlink(ignored)) {
        folder.folders.push_back(entry->path());
      }
    } else if (entry->is_regular_file(ignored) && has_bag_name(entry->path())) {
      folder.bags.push_back(entry->path());
    }
  }
  std::sort(folder.bags.begin(), folder.bags.end());
  std::sort(folder.folders.begin(), folder.folders.end());
  return folder;
}

/// The files of a folder by their container, of those that are bags by their first bytes too.
std::map<std::string_view, std::vector<fs::path>> by_container(const std::vector<fs::path>& files,
                                                               std::string_view wanted) {
  std::map<std::string_view, std::vector<fs::path>> bags;
  for (const fs::path& file : files) {
    const std::string_view container = container_of(file);
    if (!container.empty() && (wanted.empty() || container == wanted)) {
      bags[container].push_back(file);
    }
  }
  return bags;
}

void search(const fs::path& path, std::string_view wanted, int levels, std::vector<fs::path>& found) {
  if ((wanted.empty() || wanted == "rosbag2") && has_metadata(path)) {
    found.push_back(path);
    return;
  }
  const Folder folder = look_into(path);
  const auto bags = by_container(folder.bags, wanted);
  for (const auto& [container, files] : bags) {
    if (bags.size() == 1 && files.size() > 1) {
      found.push_back(path);  // the parts of one recording; whether they are is seen when they are opened
    } else {
      found.insert(found.end(), files.begin(), files.end());
    }
  }
  if (bags.empty() && levels > 0) {
    for (const fs::path& below : folder.folders) {
      search(below, wanted, levels - 1, found);
    }
  }
}

std::string listed(const std::vector<fs::path>& paths) {
  std::string lines;
  for (const fs::path& path : paths) {
    lines += "\n  " + path.string();
  }
  return lines;
}

std::vector<std::unique_ptr<FileBag>> open_all(const std::vector<fs::path>& files) {
  std::vector<std::unique_ptr<FileBag>> parts;
  parts.reserve(files.size());
  for (const fs::path& file : files) {
    parts.push_back(open_file(file));
  }
  return parts;
}

/// The parts of one recording, as far as anybody can tell.
std::unique_ptr<Bag> open_files(const fs::path& folder, const std::vector<fs::path>& files,
                                std::vector<std::string> notes) {
  std::vector<std::unique_ptr<FileBag>> parts = open_all(files);
  if (const std::string reason = why_not_one(parts); !reason.empty()) {
    throw DataError(
        fmt::format("{}: holds several recordings ({}), name one of them:{}", folder.string(), reason, listed(files)));
  }
  if (files.size() > 1) {
    notes.push_back(fmt::format("{}: {} files are read as one recording", folder.string(), files.size()));
  }
  const std::string_view container = parts.front()->container();
  return join_bags(container, std::move(parts), std::move(notes));
}

std::unique_ptr<Bag> open_metadata(const Rosbag2Metadata& metadata) {
  std::vector<std::string> notes;
  for (const fs::path& missing : metadata.missing) {
    notes.push_back(fmt::format("{}: is missing, although metadata.yaml names it", missing.string()));
  }
  std::unique_ptr<Bag> bag = join_bags("rosbag2", open_all(metadata.files), std::move(notes));
  return metadata.packed_messages ? unpacking_messages(std::move(bag)) : std::move(bag);
}

std::unique_ptr<Bag> open_folder(const fs::path& folder) {
  std::vector<std::string> notes;
  if (has_metadata(folder)) {
    try {
      return open_metadata(read_metadata(folder));
    } catch (const DataError& error) {
      notes.emplace_back(error.what());  // a recorder that is killed leaves it unfinished
      if (look_into(folder).bags.empty()) {
        throw;
      }
      notes.back() += "; the files beside it are read";
    }
  }
  const auto bags = by_container(look_into(folder).bags, {});
  if (bags.empty()) {
    throw DataError(fmt::format("{}: holds no bag: no *.bag, *.mcap or *.db3", folder.string()));
  }
  if (bags.size() > 1) {
    throw DataError(fmt::format("{}: holds several recordings, name one of them:{}", folder.string(),
                                listed(look_into(folder).bags)));
  }
  return open_files(folder, bags.begin()->second, std::move(notes));
}

}  // namespace

fs::path find_bag(const fs::path& input, std::string_view container) {
  std::error_code fault;
  const fs::file_status status = fs::status(input, fault);
  if (status.type() == fs::file_type::regular) {
    const std::string_view own = container_of(input);
    return !own.empty() && (container.empty() || own == container) ? input : fs::path();
  }
  std::vector<fs::path> found;
  if (status.type() == fs::file_type::directory) {
    search(input, container, kBagSearchDepth, found);
  }
  if (found.size() > 1) {
    throw DataError(fmt::format("{}: holds several recordings, name one of them:{}", input.string(), listed(found)));
  }
  return found.empty() ? fs::path() : found.front();
}

std::unique_ptr<Bag> open_bag(const fs::path& found) {
  std::error_code ignored;
  return fs::is_directory(found, ignored) ? open_folder(found) : open_file(found);
}

}  // namespace dynamic_icp::bags
