// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/staged_names.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

namespace dynamic_icp::formats {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<Staged, std::string_view>, 3> kStates = {
    {{Staged::kPartial, ".partial-"}, {Staged::kArriving, ".arriving-"}, {Staged::kReplaced, ".replaced-"}}};
constexpr const char* kPrefixWithin = ".dynamic-icp";

/// State and number of a name that begins with the prefix.
std::optional<std::pair<Staged, std::string>> parse(std::string_view name, std::string_view prefix) {
  for (const auto& [state, word] : kStates) {
    if (name.starts_with(prefix) && name.substr(prefix.size()).starts_with(word)) {
      const std::string_view number = name.substr(prefix.size() + word.size());
      if (!number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos) {
        return std::pair(state, std::string(number));
      }
    }
  }
  return std::nullopt;
}

}  // namespace

StagedNames::StagedNames(fs::path folder, std::string prefix)
    : folder_(std::move(folder)), prefix_(std::move(prefix)) {}

StagedNames StagedNames::beside(const fs::path& folder) {
  return {folder.parent_path(), fmt::format(".{}", folder.filename().string())};
}

StagedNames StagedNames::within(const fs::path& folder) { return {folder, kPrefixWithin}; }

fs::path StagedNames::path(Staged state, const std::string& number) const {
  for (const auto& [known, word] : kStates) {
    if (known == state) {
      return folder_ / (prefix_ + std::string(word) + number);
    }
  }
  return {};
}

std::vector<StagedNames::Found> StagedNames::found() const {
  std::vector<Found> result;
  std::error_code fault;
  for (fs::directory_iterator entry(folder_, fault); !fault && entry != fs::directory_iterator();
       entry.increment(fault)) {
    if (auto parsed = parse(entry->path().filename().string(), prefix_)) {
      result.push_back({entry->path(), parsed->first, parsed->second});
    }
  }
  return result;
}

std::vector<fs::path> partial_folders(const fs::path& folder) {
  std::vector<fs::path> result;
  std::error_code fault;
  for (fs::directory_iterator entry(folder, fault); !fault && entry != fs::directory_iterator();
       entry.increment(fault)) {
    const std::string name = entry->path().filename().string();
    const std::size_t word = name.rfind(".partial-");
    std::error_code ignored;
    if (name.starts_with('.') && word != std::string::npos && word > 1 && parse(name, name.substr(0, word)) &&
        entry->symlink_status(ignored).type() == fs::file_type::directory) {
      result.push_back(entry->path());
    }
  }
  return result;
}

bool is_staged_within(std::string_view name) { return parse(name, kPrefixWithin).has_value(); }

}  // namespace dynamic_icp::formats
