// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/benchmark/plan_file.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/json_row.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/benchmark/cell_run.hpp"

namespace dynamic_icp::benchmark {
namespace {

namespace fs = std::filesystem;
using PlanJson = nlohmann::ordered_json;

PlanJson plan_json(const CellPlan& cell) {
  return {{"sequence", cell.key.sequence},
          {"method", cell.key.method},
          {"ablation", cell.key.ablation},
          {"folder", cell.folder.string()},
          {"arguments", cell.arguments},
          {"fingerprint", PlanJson::parse(cell.fingerprint)},
          {"object_truth", cell.object_truth.string()},
          {"scans", cell.scans},
          {"bytes_per_scan", cell.bytes_per_scan}};
}

/// A folder that a plan may have a cell write to: below that of the plan.
bool is_below(const fs::path& folder) {
  return !folder.empty() && folder.is_relative() &&
         std::none_of(folder.begin(), folder.end(), [](const fs::path& part) { return part == ".." || part == "."; });
}

CellPlan cell_plan(const PlanJson& json) {
  CellPlan cell;
  cell.key = {json.at("sequence").get<std::string>(), json.at("method").get<std::string>(),
              json.at("ablation").get<std::string>()};
  cell.folder = json.at("folder").get<std::string>();
  cell.arguments = json.at("arguments").get<std::vector<std::string>>();
  cell.fingerprint = json.at("fingerprint").dump();
  cell.object_truth = json.at("object_truth").get<std::string>();
  cell.scans = json.at("scans").get<std::size_t>();
  cell.bytes_per_scan = json.at("bytes_per_scan").get<std::size_t>();
  return cell;
}

}  // namespace

void write_plan(const fs::path& folder, const Program& program, const std::vector<CellPlan>& cells) {
  PlanJson json = {{"program", {{"version", program.version}, {"checksum", program.checksum}}},
                   {"cells", PlanJson::array()}};
  for (const CellPlan& cell : cells) {
    json["cells"].push_back(plan_json(cell));
  }
  std::string text;
  try {
    text = json.dump(2) + "\n";
  } catch (const PlanJson::exception& error) {
    throw DataError(fmt::format("{}: a plan cannot hold names that are not UTF-8: {}", (folder / kPlanName).string(),
                                error.what()));
  }
  formats::write_whole_file(folder / kPlanName, text);
}

PlanFile read_plan(const fs::path& folder) {
  const fs::path path = folder / kPlanName;
  const PlanJson json = formats::read_json_object(path);
  try {
    PlanFile plan;
    plan.version = json.at("program").at("version").get<std::string>();
    plan.checksum = json.at("program").at("checksum").get<std::string>();
    for (const PlanJson& cell : json.at("cells")) {
      plan.cells.push_back(cell_plan(cell));
      if (!is_below(plan.cells.back().folder)) {
        throw DataError(fmt::format("{}: the folder '{}' of a cell is not below that of the plan", path.string(),
                                    plan.cells.back().folder.string()));
      }
    }
    return plan;
  } catch (const PlanJson::exception& error) {
    throw DataError(fmt::format("{}: not the plan of a benchmark: {}", path.string(), error.what()));
  }
}

const CellPlan& find_cell(const PlanFile& plan, const fs::path& folder) {
  const fs::path wanted = folder.lexically_normal();
  const auto cell =
      std::find_if(plan.cells.begin(), plan.cells.end(), [&](const CellPlan& each) { return each.folder == wanted; });
  if (cell == plan.cells.end()) {
    throw UsageError(
        fmt::format("the plan has no cell '{}'; expected SEQUENCE/METHOD or SEQUENCE/METHOD_ABLATION as in {}",
                    folder.string(), kPlanName));
  }
  return *cell;
}

std::vector<CellResult> collect_results(const fs::path& folder, const PlanFile& plan) {
  std::vector<CellResult> results;
  for (const CellPlan& cell : plan.cells) {
    if (auto saved = ended_result(folder, cell)) {
      results.push_back(std::move(*saved));
      continue;
    }
    CellResult& missing = results.emplace_back();
    missing.key = cell.key;
    missing.folder = cell.folder;
    missing.failure = "not run";
  }
  return results;
}

}  // namespace dynamic_icp::benchmark
