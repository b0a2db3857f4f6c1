// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"

#include <system_error>

#include <fmt/format.h>

#include "dynamic_icp/recording/datasets/folder_search.hpp"
#include "dynamic_icp/recording/formats/file_kind.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

std::string sentence_of(const fs::path& file) {
  try {
    const std::string_view what = formats::sentence(formats::kind_of_file(file));
    return what.empty() ? "" : fmt::format("{}: {}", file.string(), what);
  } catch (const DataError&) {
    return "";  // a file that cannot be read tells nothing
  }
}

}  // namespace

std::string known_obstacle(const fs::path& input) {
  std::error_code fault;
  if (fs::is_regular_file(input, fault)) {
    return sentence_of(input);
  }
  const auto is_file = [&](const fs::directory_entry& entry) { return entry.is_regular_file(fault); };
  for (const fs::path& file : entries_of(input, is_file)) {
    if (std::string sentence = sentence_of(file); !sentence.empty()) {
      return sentence;
    }
  }
  return "";
}

}  // namespace dynamic_icp::datasets
