// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/raw_scan.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/field_names.hpp"
#include "dynamic_icp/recording/datasets/point_times.hpp"
#include "dynamic_icp/recording/formats/npy.hpp"

namespace dynamic_icp::datasets {

/// One scan as arrays that have names: a file, the points of a message.
class NamedColumns {
 public:
  virtual ~NamedColumns() = default;

  /// The names of the arrays of numbers, in the order of the file.
  [[nodiscard]] virtual const std::vector<std::string>& names() const = 0;

  /// The array of that name. Throws DataError where there is none or it is damaged.
  [[nodiscard]] virtual formats::NpyArray read(const std::string& name) const = 0;

  /// What was odd but could be lived with; empty: nothing.
  [[nodiscard]] virtual std::string warning() const { return {}; }
};

/// What the columns of a recording mean, found once for all its scans.
struct ColumnMeaning {
  FieldMap fields;
  TimeUnit time_unit;
};

/// A scan of the recording, and what stands for its file in messages.
struct ColumnsOfScan {
  std::unique_ptr<NamedColumns> columns;
  std::filesystem::path origin;
};

/// Finds the unit of the times of points by the first scan that has some, what spherical coordinates leave open
/// (spherical_fields.hpp), and leaves out channels that it contradicts; what was found goes to the assumptions, after
/// those of `fields`. `open` opens one of the `scans` scans, of which the
/// first may be empty: a few are looked at. Throws DataError as reading them does.
ColumnMeaning find_meaning(FieldMap fields, std::size_t scans, const std::function<ColumnsOfScan(std::size_t)>& open,
                           double period_s, std::vector<std::string>& assumptions);

/// The scan that the columns say: all but its kind of Doppler and its mountings. `origin` stands for its file in
/// messages. Throws DataError where columns differ in length or hold numbers that nobody measured.
RawScan read_scan(const NamedColumns& columns, const ColumnMeaning& meaning, Stamp stamp,
                  const std::filesystem::path& origin);

/// The columns beside point, Doppler, time and line of sight; arrays of several get a name for each.
std::vector<PointColumn> other_columns(const NamedColumns& columns, const FieldMap& fields,
                                       const std::filesystem::path& origin);

}  // namespace dynamic_icp::datasets
