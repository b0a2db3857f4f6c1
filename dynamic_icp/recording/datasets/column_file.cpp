// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/column_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr const char* kPointsColumn = "points";
constexpr const char* kDopplerColumn = "doppler";

/// The column as an array; integers get the one type that holds them all.
formats::NpyArray array_of(const formats::PlyColumn& column) {
  const formats::NpyType type = formats::is_float(column.type) ? column.type : formats::NpyType::kInt64;
  return formats::array_of(type, {column.values.size()}, column.values);
}

/// All columns of a text as one array.
formats::NpyArray array_of(const formats::CsvTable& table, const std::filesystem::path& path) {
  std::vector<std::vector<double>> columns;
  for (const formats::NpyArray& column : table.columns) {
    columns.push_back(formats::column_as_doubles(column));
  }
  const std::size_t rows = columns.empty() ? 0 : columns.front().size();
  std::vector<double> values;
  values.reserve(rows * columns.size());
  for (std::size_t row = 0; row < rows; ++row) {
    for (const std::vector<double>& column : columns) {
      values.push_back(column[row]);
    }
  }
  formats::NpyArray array = formats::array_of(formats::NpyType::kFloat64, {rows, columns.size()}, values);
  array.origin = path.string();
  return array;
}

formats::NpyArray column_of(const formats::CsvTable& table, const std::string& name,
                            const std::filesystem::path& path) {
  const auto found = std::find(table.names.begin(), table.names.end(), name);
  if (found == table.names.end()) {
    throw DataError(fmt::format("{}: has no column '{}'", path.string(), name));
  }
  return table.columns[static_cast<std::size_t>(found - table.names.begin())];
}

const formats::PlyElement& vertices(const formats::PlyFile& file, const std::filesystem::path& path) {
  const formats::PlyElement* const found = file.find("vertex");
  if (found == nullptr) {
    throw DataError(fmt::format("{}: has no element 'vertex', expected one with the points", path.string()));
  }
  return *found;
}

}  // namespace

ColumnFile::ColumnFile(ColumnFileKind kind, const std::filesystem::path& path) : path_(path) {
  switch (kind) {
    case ColumnFileKind::kNpz: {
      const formats::NpzFile& npz = file_.emplace<formats::NpzFile>(path);
      for (std::string& name : npz.names()) {
        std::string reason = npz.why_no_numbers(name);
        if (reason.empty()) {
          names_.push_back(std::move(name));
        } else {
          unusable_.push_back(std::move(reason));
        }
      }
      break;
    }
    case ColumnFileKind::kPcd:
      names_ = file_.emplace<formats::PcdFile>(path).names();
      break;
    case ColumnFileKind::kPly:
      for (const formats::PlyColumn& column :
           vertices(file_.emplace<formats::PlyFile>(formats::read_ply(path)), path).columns) {
        if (!column.is_list) {
          names_.push_back(column.name);
        }
      }
      break;
    case ColumnFileKind::kNpy:
      file_ = NpyFile{path};
      names_ = {kPointsColumn};
      break;
    case ColumnFileKind::kCsv: {
      const formats::CsvTable& table = file_.emplace<formats::CsvTable>(formats::read_csv(path));
      names_ = table.names;
      if (names_.empty() && !table.columns.empty()) {
        names_ = {kPointsColumn};
      }
      break;
    }
    case ColumnFileKind::kNpyPair:
      file_ = NpyPair{path};
      names_ = {kPointsColumn, kDopplerColumn};
      break;
  }
}

std::filesystem::path ColumnFile::doppler_file(const std::filesystem::path& points) {
  return points.parent_path() / (points.stem().string() + "_dop.npy");
}

std::string ColumnFile::warning() const {
  const auto* const pcd = std::get_if<formats::PcdFile>(&file_);
  return pcd == nullptr ? "" : pcd->warning();
}

formats::NpyArray ColumnFile::read(const std::string& name) const {
  if (const auto* const npz = std::get_if<formats::NpzFile>(&file_)) {
    return npz->read(name);
  }
  if (const auto* const pcd = std::get_if<formats::PcdFile>(&file_)) {
    return pcd->read(name);
  }
  if (const auto* const pair = std::get_if<NpyPair>(&file_)) {
    return formats::read_npy(name == kPointsColumn ? pair->points : doppler_file(pair->points));
  }
  if (const auto* const npy = std::get_if<NpyFile>(&file_)) {
    return formats::read_npy(npy->path);
  }
  if (const auto* const table = std::get_if<formats::CsvTable>(&file_)) {
    return table->names.empty() ? array_of(*table, path_) : column_of(*table, name, path_);
  }
  const formats::PlyColumn* const column = vertices(std::get<formats::PlyFile>(file_), path_).find(name);
  if (column == nullptr || column->is_list) {
    throw DataError(fmt::format("{}: has no property '{}' of vertices", path_.string(), name));
  }
  formats::NpyArray array = array_of(*column);
  array.origin = fmt::format("{}: property '{}'", path_.string(), name);
  return array;
}

}  // namespace dynamic_icp::datasets
