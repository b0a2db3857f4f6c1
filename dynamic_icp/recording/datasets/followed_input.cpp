// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/followed_mcap.hpp"
#include "dynamic_icp/recording/bags/growing_bytes.hpp"
#include "dynamic_icp/recording/bags/mcap_records.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/followed_bag.hpp"
#include "dynamic_icp/recording/datasets/followed_folder.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::FileKind;
using std::chrono::steady_clock;

constexpr std::string_view kWhatCanBe =
    "expected a folder that files of scans are put into, an MCAP file that grows, or - for MCAP on standard input";

[[noreturn]] void refuse(const fs::path& input, std::string_view why) {
  throw UsageError(fmt::format("'{}' cannot be followed: {}{}", input.string(), why, kWhatCanBe));
}

std::unique_ptr<FollowedDataset> follow_file(const fs::path& file, const InputSettings& settings, std::size_t first) {
  formats::refuse_irregular(file);
  std::error_code ignored;
  switch (formats::kind_of_file(file)) {
    case FileKind::kMcap:
      break;
    case FileKind::kRosBag:
    case FileKind::kOldRosBag:
      refuse(file, "it is a ROS 1 bag, whose index comes last; ");
    case FileKind::kSqlite:
      refuse(file, "it is a database of ROS 2 (.db3), which is read as a whole; ");
    case FileKind::kUnknown:
      // Who writes it may not have come to its mark yet.
      if (file.extension() != ".mcap" || fs::file_size(file, ignored) >= bags::kMcapMagic.size()) {
        refuse(file, "");
      }
      break;
    default:
      refuse(file, "");
  }
  return follow_bag(std::make_unique<bags::FollowedMcap>(bags::growing_file(file)), file, settings, first);
}

/// A folder of ROS 2, for one.
bool holds_bag(const fs::path& folder, const OpenOptions& options) {
  try {
    return find_dataset(folder, options).is_bag();
  } catch (const DataError&) {
    return false;
  }
}

std::unique_ptr<FollowedDataset> open_followed(const fs::path& input, const InputSettings& settings,
                                               std::size_t first) {
  if (input == kStandardInput) {
    if (::isatty(STDIN_FILENO) != 0) {
      throw UsageError("standard input is a terminal: expected an MCAP file through a pipe");
    }
    return follow_bag(std::make_unique<bags::FollowedMcap>(bags::growing_stream(STDIN_FILENO, "standard input")), {},
                      settings, first);
  }
  if (fs::exists(input) && !fs::is_directory(input)) {
    return follow_file(input, settings, first);
  }
  if (fs::is_directory(input) && holds_bag(input, settings.open)) {
    refuse(input, "it holds a bag, whose MCAP file is to be named; ");
  }
  return follow_folder(input, settings);
}

}  // namespace

std::unique_ptr<FollowedDataset> follow_input(const fs::path& input, const InputSettings& settings,
                                              const FirstScans& first, const std::function<bool()>& stop) {
  std::unique_ptr<FollowedDataset> followed = open_followed(input, settings, first.count);
  bool is_silent = false;
  for (std::size_t i = 0; i < first.begin + first.count && !is_silent; ++i) {
    followed->release_before(std::min(i, first.begin));
    const steady_clock::time_point begun = steady_clock::now();
    const auto stop_waiting = [&] {
      is_silent = first.longest_silence && steady_clock::now() - begun > *first.longest_silence;
      return is_silent || stop();
    };
    if (!followed->wait_for(i, stop_waiting)) {
      break;
    }
  }
  if (followed->size() == 0 && is_silent) {
    throw DataError(fmt::format("{}: no scan came for {} s", input.string(), first.longest_silence->count()));
  }
  return followed->size() > 0 && !stop() ? std::move(followed) : nullptr;
}

}  // namespace dynamic_icp::datasets
