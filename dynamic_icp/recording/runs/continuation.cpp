// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/continuation.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/folder_entries.hpp"
#include "dynamic_icp/recording/formats/own_files.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/runs/scan_record.hpp"

namespace dynamic_icp::runs {
namespace {

namespace fs = std::filesystem;

/// What a run writes scan by scan, and last the checkpoint that tells how far it came: without it a copy counts
/// nothing.
constexpr std::array<std::string_view, 5> kWrittenAlong = {"frames.jsonl", "objects.jsonl", "labels", kScanRecordsFile,
                                                           kCheckpointFile};

/// Removes what lies in a folder, but for these entries.
template <class Keep>
void remove_all_but(const fs::path& folder, const Keep& keep) {
  std::vector<fs::path> others;
  for (const fs::directory_entry& entry : formats::entries_in(folder)) {
    if (std::find(keep.begin(), keep.end(), entry.path().filename().string()) == keep.end()) {
      others.push_back(entry.path());
    }
  }
  for (const fs::path& other : others) {
    fs::remove_all(other);
  }
}

/// The checkpoint in a folder; nothing where there is none, or a damaged one, which is told.
std::optional<Checkpoint> checkpoint_in(const fs::path& folder,
                                        const std::function<void(const std::string& text)>& notice) {
  std::error_code fault;
  if (!fs::exists(folder / kCheckpointFile, fault)) {
    return std::nullopt;
  }
  try {
    return read_checkpoint(folder);
  } catch (const DataError& error) {
    notice(fmt::format("{}; the run begins anew", error.what()));
    return std::nullopt;
  }
}

/// A checkpoint is trusted as the memory of the program is, and the files beside it are written on.
void refuse_foreign(const formats::OutputFolder& output, const fs::path& final, const fs::path& path) {
  try {
    formats::refuse_foreign_files(path, output.path());
  } catch (const DataError& error) {
    throw DataError(
        fmt::format("{}: cannot resume the run: {}; remove it to begin anew", final.string(), error.what()));
  }
}

void refuse_difference(const fs::path& folder, const std::optional<std::string>& different) {
  if (different) {
    throw DataError(fmt::format("{}: cannot resume the run: {}", folder.string(), *different));
  }
}

/// Whether nothing of what was asked for is missing. A checkpoint stays with what was stopped or could not be made.
bool is_complete(const fs::path& folder, const nlohmann::json& about, const nlohmann::json& identity) {
  const auto is_missing = [&](const char* asked, const char* made) {
    return !identity.value(asked, nlohmann::json()).is_null() && about.value(made, nlohmann::json()).is_null();
  };
  return !about.value("stopped", false) && !fs::exists(folder / kCheckpointFile) && !is_missing("save_map", "map") &&
         !is_missing("save_kitti", "kitti") && (!identity.value("save_labels", false) || fs::exists(folder / "labels"));
}

Continuation after_killed(const formats::OutputFolder& output, const fs::path& final, const std::string& identity,
                          const std::function<void(const std::string& text)>& notice) {
  refuse_foreign(output, final, output.path());
  Continuation result;
  result.from = checkpoint_in(output.path(), notice);
  if (result.from) {
    refuse_difference(final, difference(result.from->identity, identity));
  }
  remove_all_but(output.path(), kWrittenAlong);
  return result;
}

Continuation after_written(const formats::OutputFolder& output, const fs::path& final, const std::string& identity,
                           bool replace, const std::function<void(const std::string& text)>& notice) {
  const std::string about = formats::read_text_file(final / "run.json");
  const auto is_shallow = [](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    return depth <= kMaxDepthOfSettings;
  };
  const nlohmann::json json = nlohmann::json::parse(about, is_shallow, false);
  if (!json.is_object()) {
    throw DataError(fmt::format("{}: is no JSON object", (final / "run.json").string()));
  }
  Continuation result;
  const std::optional<std::string> different = difference(about, identity);
  if (different && replace) {
    return result;
  }
  refuse_difference(final, different);
  result.is_complete = is_complete(final, json, nlohmann::json::parse(identity));
  if (result.is_complete) {
    return result;
  }
  for (const std::string_view name : kWrittenAlong) {
    std::error_code missing;
    if (fs::symlink_status(final / name, missing).type() != fs::file_type::not_found) {
      refuse_foreign(output, final, final / name);
    }
  }
  result.from = checkpoint_in(final, notice);
  if (result.from) {
    refuse_difference(final, difference(result.from->identity, identity));
    for (const std::string_view name : kWrittenAlong) {
      if (fs::exists(final / name)) {
        fs::copy(final / name, output.path() / name, fs::copy_options::recursive);
      }
    }
  }
  return result;
}

}  // namespace

Continuation continuation(const formats::OutputFolder& output, const fs::path& final, const std::string& identity,
                          bool replace, const std::function<void(const std::string& text)>& notice) {
  try {
    if (output.had_checkpoint()) {
      return after_killed(output, final, identity, notice);
    }
    std::error_code fault;
    return fs::exists(final / "run.json", fault) ? after_written(output, final, identity, replace, notice)
                                                 : Continuation{};
  } catch (const fs::filesystem_error& error) {
    throw DataError(fmt::format("{}: cannot resume the run: {}", final.string(), error.code().message()));
  } catch (const nlohmann::json::exception&) {
    throw DataError(
        fmt::format("{}: cannot resume the run: its run.json or checkpoint is not what a run writes", final.string()));
  }
}

void refuse_other_scans(const Checkpoint& from, const datasets::Dataset& dataset, const datasets::ScanRange& scans,
                        const fs::path& final) {
  if (from.next <= scans.begin || from.next >= scans.end) {
    throw DataError(fmt::format("{}: cannot resume the run: its checkpoint is of scan {}, expected {} to {}",
                                final.string(), from.next, scans.begin + 1, scans.end - 1));
  }
  if (checksum(dataset.scan(from.next - 1)) != from.last_scan) {
    throw DataError(fmt::format("{}: cannot resume the run: {} is not what it was", final.string(),
                                dataset.scan_file(from.next - 1).string()));
  }
}

void remove_files_of_run(const fs::path& staging) {
  for (const std::string_view name : kWrittenAlong) {
    fs::remove_all(staging / name);
  }
}

}  // namespace dynamic_icp::runs
