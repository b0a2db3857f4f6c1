// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/run_report.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/tools/report/object_details.hpp"
#include "dynamic_icp/tools/report/run_data.hpp"
#include "dynamic_icp/tools/report/run_facts.hpp"

namespace dynamic_icp::report {
namespace {

/// The kept scan that a page begins with: the first one with moving objects, a quarter of the way into the drive, else
/// the first one there.
std::size_t first_shown(const runs::RunFiles& run, const std::vector<KeptScan>& scans) {
  const std::size_t begin = run.frames.size() / 4;
  const auto there =
      std::find_if(scans.begin(), scans.end(), [&](const KeptScan& scan) { return scan.frame >= begin; });
  const auto found =
      std::find_if(there, scans.end(), [&](const KeptScan& scan) { return !run.objects[scan.frame].empty(); });
  if (found != scans.end()) {
    return static_cast<std::size_t>(found - scans.begin());
  }
  return there != scans.end() ? static_cast<std::size_t>(there - scans.begin()) : scans.size() - 1;
}

/// Puts what the first picture needs before everything else: the scan that is shown, and the first one, which tells
/// where the sensor looks.
void put_first(std::size_t run, std::size_t shown, PageContent& content) {
  const std::string ids[] = {fmt::format("scan-{}-{}", run, shown), fmt::format("scan-{}-0", run)};
  const auto rest = std::stable_partition(content.blobs.begin(), content.blobs.end(), [&](const auto& blob) {
    return std::find(std::begin(ids), std::end(ids), blob.first) != std::end(ids);
  });
  content.first_blobs = static_cast<std::size_t>(rest - content.blobs.begin());
}

/// The entry "scans" of a run; its blobs go to `content`.
Json scans_data(std::size_t run, RunScans& kept, PageContent& content) {
  if (kept.scans.empty()) {
    return nullptr;
  }
  Json data = {{"frames", Json::array()},
               {"dt", Json::array()},
               {"whole", Json::array()},
               {"points", Json::array()},
               {"of", Json::array()}};
  for (std::size_t k = 0; k < kept.scans.size(); ++k) {
    KeptScan& scan = kept.scans[k];
    data["frames"].push_back(scan.frame);
    data["dt"].push_back(rounded(scan.dt_s, 6));
    data["whole"].push_back(scan.whole);
    data["points"].push_back(scan.points);
    data["of"].push_back(scan.of);
    content.blobs.emplace_back(fmt::format("scan-{}-{}", run, k), std::move(scan.blob));
  }
  return data;
}

/// The entry of a map of a run; its blob goes to `content`, called by `name` and the number of the run.
Json map_data(const char* name, std::size_t run, std::optional<KeptMap>& map, PageContent& content) {
  if (!map) {
    return nullptr;
  }
  content.blobs.emplace_back(fmt::format("{}-{}", name, run), std::move(map->blob));
  return {{"points", map->points}, {"cell", rounded(map->cell_m, 3)}};
}

}  // namespace

PageContent run_report(const std::filesystem::path& folder, const ScanChoice& choice, const Workers& workers) {
  const runs::RunFiles run = runs::read_run(folder);
  std::vector<std::string> notes;
  RunScans kept;
  std::optional<figures::RunTruth> truth;
  if (run.frames.empty()) {
    notes.emplace_back("The run holds no scans.");
  } else {
    const std::unique_ptr<datasets::Dataset> recording = figures::open_recording(run, notes);
    truth = figures::read_truth(run, recording.get(), notes);
    if (recording != nullptr) {
      try {
        kept = keep_scans(run, truth, *recording, choice, workers);
      } catch (const DataError& error) {
        notes.push_back(fmt::format("No scans are shown. {}", error.what()));
      }
    }
  }
  notes.insert(notes.end(), kept.notes.begin(), kept.notes.end());

  PageContent content;
  Json data = run_data(run, truth, name_of(run));
  data["frames"]["object_details"] = object_details(run);
  data["scans"] = scans_data(0, kept, content);
  data["map"] = map_data("map", 0, kept.map, content);
  data["traces"] = map_data("traces", 0, kept.traces, content);
  if (!kept.scans.empty()) {
    const std::size_t shown = first_shown(run, kept.scans);
    data["scans"]["first"] = shown;
    put_first(0, shown, content);
  }
  content.report = {{"schema", 1},           {"kind", "run"},
                    {"title", name_of(run)}, {"generator", generator()},
                    {"notes", notes},        {"runs", Json::array({std::move(data)})}};
  return content;
}

}  // namespace dynamic_icp::report
