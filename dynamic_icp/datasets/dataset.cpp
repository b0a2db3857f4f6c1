// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/datasets/dataset.hpp"

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"
#include "dynamic_icp/datasets/aevascenes.hpp"
#include "dynamic_icp/datasets/column_folder.hpp"
#include "dynamic_icp/datasets/dicp.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

/// One row a layout: how it is recognised and how it is opened.
struct Layout {
  std::string_view name;
  std::string_view looks_like;
  fs::path (*find)(const fs::path& input);  ///< the folder to open; empty when the input is not of this layout
  std::unique_ptr<Dataset> (*open)(const fs::path& folder, const OpenOptions& options);
};

constexpr Layout kLayouts[] = {
    {"dicp", "a folder with point_clouds/*.bin", find_dicp, open_dicp},
    {"aevascenes", "sequence.json beside pointcloud_compensated/ or pointcloud_raw/", find_aevascenes, open_aevascenes},
    // What any data set may hold comes last.
    {"npz", "*.npz, or <name>.npy with <name>_dop.npy", find_npz, open_npz},
    {"pcd", "*.pcd", find_pcd, open_pcd},
    {"ply", "*.ply", find_ply, open_ply},
};

std::string looked_for() {
  std::string text;
  for (const Layout& layout : kLayouts) {
    text += fmt::format("\n  {}: {}", layout.name, layout.looks_like);
  }
  return text;
}

std::unique_ptr<Dataset> open_as(const Layout& layout, const fs::path& input, const OpenOptions& options) {
  const fs::path folder = layout.find(input);
  return folder.empty() ? nullptr : layout.open(folder, options);
}

}  // namespace

std::vector<std::string> known_formats() {
  std::vector<std::string> names;
  for (const Layout& layout : kLayouts) {
    names.emplace_back(layout.name);
  }
  return names;
}

std::unique_ptr<Dataset> open_dataset(const fs::path& input, const OpenOptions& options) {
  if (!fs::exists(input)) {
    throw DataError(fmt::format("{}: no such file or folder", input.string()));
  }
  const std::string& format = options.format;
  bool known = format == "auto";
  for (const Layout& layout : kLayouts) {
    known = known || format == layout.name;
    if (format == "auto" || format == layout.name) {
      if (std::unique_ptr<Dataset> dataset = open_as(layout, input, options)) {
        return dataset;
      }
    }
  }
  if (!known) {
    throw UsageError(fmt::format("unknown format '{}'; known are: auto{}", format, looked_for()));
  }
  throw DataError(fmt::format("{}: not a recording of a known layout. Looked for:{}", input.string(), looked_for()));
}

}  // namespace dynamic_icp::datasets
