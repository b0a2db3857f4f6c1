// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/named_rows.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/likely_doppler.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::string_view kFirstUnnamed = "arr_0";
constexpr std::string_view kSecondUnnamed = "arr_1";
constexpr std::size_t kPlainColumns = 4;
constexpr std::size_t kMaxPointNumbers = 64;   // a wider array has its points side by side
constexpr std::size_t kMaxColumnsOfRows = 64;  // of an array, as many as can be named

bool same_text(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char one, char other) { return lower(one) == lower(other); });
}

const std::string* find_name(const NamedColumns& scan, std::string_view name) {
  const std::vector<std::string>& names = scan.names();
  const auto exact = std::find(names.begin(), names.end(), name);
  const auto found = exact != names.end() ? exact : std::find_if(names.begin(), names.end(), [&](const auto& own) {
    return same_text(own, name);
  });
  return found == names.end() ? nullptr : &*found;
}

/// 0 for what is no array of points.
std::size_t width_of(const formats::NpyArray& array) {
  return array.shape.size() == 2 ? array.shape[1] : array.shape.size() == 1 ? 1 : 0;
}

class NamedRowsColumns final : public NamedColumns {
 public:
  NamedRowsColumns(std::unique_ptr<NamedColumns> scan, NamedRows rows)
      : scan_(std::move(scan)), rows_(std::move(rows)) {
    for (const std::string& name : scan_->names()) {
      if (name != rows_.array) {
        names_.push_back(name);
        continue;
      }
      std::copy_if(rows_.names.begin(), rows_.names.end(), std::back_inserter(names_),
                   [](const std::string& column) { return column != "_"; });
    }
  }

  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] std::string warning() const override { return scan_->warning(); }

  [[nodiscard]] formats::NpyArray read(const std::string& name) const override {
    const auto column = std::find(rows_.names.begin(), rows_.names.end(), name);
    if (column == rows_.names.end()) {
      return scan_->read(name);
    }
    if (!array_) {
      array_ = scan_->read(rows_.array);
    }
    if (width_of(*array_) != rows_.names.size()) {
      throw DataError(fmt::format("{}: has the shape ({}), expected (N, {})", array_->origin,
                                  fmt::join(array_->shape, ", "), rows_.names.size()));
    }
    return column_of(static_cast<std::size_t>(column - rows_.names.begin()));
  }

 private:
  /// In the type that it is stored in.
  [[nodiscard]] formats::NpyArray column_of(std::size_t column) const {
    const std::size_t bytes = formats::size_of(array_->type);
    const std::size_t rows = formats::rows_of(*array_);
    formats::NpyArray result{array_->type, {rows}, {}, fmt::format("{}: column {}", array_->origin, column)};
    result.bytes.reserve(rows * bytes);
    for (std::size_t row = 0; row < rows; ++row) {
      result.bytes.append(array_->bytes, (row * rows_.names.size() + column) * bytes, bytes);
    }
    return result;
  }

  std::unique_ptr<NamedColumns> scan_;
  NamedRows rows_;
  std::vector<std::string> names_;
  mutable std::optional<formats::NpyArray> array_;  ///< read once for all of its columns
};

std::vector<std::vector<double>> columns_of_array(const formats::NpyArray& array) {
  std::vector<std::vector<double>> columns;
  for (std::size_t k = 0; k < width_of(array); ++k) {
    columns.push_back(formats::column_as_doubles(array, k));
  }
  return columns;
}

bool states_part_of(const std::map<std::string, std::string>& fields, const std::string& array) {
  return std::any_of(fields.begin(), fields.end(),
                     [&](const auto& field) { return field.second.starts_with(array + "["); });
}

/// Names for the columns of an array of which only the first three are known.
std::vector<std::string> point_names(const std::string& array, std::size_t width) {
  std::vector<std::string> names = {"x", "y", "z"};
  for (std::size_t k = names.size(); k < width; ++k) {
    names.push_back(fmt::format("{}[{}]", array, k));
  }
  return names;
}

/// The array of the points: as the user says, else by its name; null: none.
const std::string* array_of_points(const NamedColumns& scan, const std::map<std::string, std::string>& fields,
                                   const std::string& origin) {
  if (const auto asked = fields.find("points"); asked != fields.end()) {
    const std::string* const found = find_name(scan, asked->second);
    if (found == nullptr) {
      throw DataError(fmt::format("{}: no array '{}' for the points; there are: {}", origin, asked->second,
                                  fmt::join(scan.names(), ", ")));
    }
    return found;
  }
  if (find_name(scan, "x") != nullptr || fields.contains("x")) {
    return nullptr;
  }
  for (const std::string_view name : {"points", "xyz", "pts", "positions"}) {
    if (const std::string* const found = find_name(scan, name)) {
      return found;
    }
  }
  return find_name(scan, kFirstUnnamed);
}

/// Whether a Doppler is found without the array.
bool has_doppler_beside(const NamedColumns& scan, const std::map<std::string, std::string>& fields) {
  return fields.contains("doppler") || has_doppler_name(scan.names());
}

std::string numbers_as_columns(const formats::NpyArray& array) {
  const std::vector<std::vector<double>> columns = columns_of_array(array);
  return proposed_columns(columns);
}

}  // namespace

void refuse_stated_columns(const FieldMap& fields, const OpenOptions& options, const std::filesystem::path& origin) {
  if (fields.spherical && !options.columns.empty()) {
    throw UsageError(fmt::format(
        "{}: its columns '{}', '{}' and '{}' have names and are read as spherical coordinates: state which are meant, "
        "and in which unit, by their names (azimuth_deg, elevation_deg, range), not what all are in their order",
        origin.string(), fields.point[0].array, fields.point[1].array, fields.point[2].array));
  }
}

std::unique_ptr<NamedColumns> with_rows(std::unique_ptr<NamedColumns> scan, const NamedRows& rows) {
  return rows.array.empty() ? std::move(scan) : std::make_unique<NamedRowsColumns>(std::move(scan), rows);
}

ArrayReading read_arrays_as(const NamedColumns& scan, const OpenOptions& options, const std::filesystem::path& origin) {
  ArrayReading reading;
  reading.fields = options.fields;
  const std::string* const points = array_of_points(scan, options.fields, origin.string());
  reading.fields.erase("points");
  const bool states_more =
      !options.columns.empty() && options.columns != std::vector<std::string>{"x", "y", "z", "doppler"};
  if (points == nullptr || states_part_of(options.fields, *points)) {
    if (states_more) {
      throw UsageError(fmt::format(
          "{}: its columns have names ({}): state which are meant by their names, not what all are in their "
          "order",
          origin.string(), fmt::join(scan.names(), ", ")));
    }
    return reading;
  }
  const formats::NpyArray array = scan.read(*points);
  const std::size_t width = width_of(array);
  if (width < 3) {
    if (options.fields.contains("points")) {
      throw DataError(fmt::format("{}: has the shape ({}), expected (N, 3) or wider of the points", array.origin,
                                  fmt::join(array.shape, ", ")));
    }
    return reading;  // what reads the points says what is wrong with them
  }
  if (formats::rows_of(array) <= kMaxPointNumbers && width > kMaxColumnsOfRows) {
    throw DataError(
        fmt::format("{}: has the shape ({}), expected a row for each point; write it the other way round with Python: "
                    "import numpy; numpy.save(FILE, numpy.load(FILE).T)",
                    array.origin, fmt::join(array.shape, ", ")));
  }
  reading.rows.array = *points;
  if (states_more) {
    if (options.columns.size() != width) {
      throw UnclearInput(fmt::format("{}: has {} columns, but {} are stated ({})", array.origin, width,
                                     options.columns.size(), fmt::join(options.columns, ",")),
                         {{"columns", numbers_as_columns(array)}});
    }
    reading.rows.names = options.columns;
    return reading;
  }
  reading.rows.names = point_names(*points, width);
  if (width == 3 && *points == kFirstUnnamed && !has_doppler_beside(scan, options.fields)) {
    if (const std::string* const second = find_name(scan, kSecondUnnamed);
        second != nullptr && width_of(scan.read(*second)) == 1) {
      reading.fields["doppler"] = *second;
      reading.assumptions.push_back(
          fmt::format("{}: {} is taken for the points and {} for the Doppler", origin.string(), *points, *second));
    }
  }
  if (width == 3 || has_doppler_beside(scan, options.fields)) {
    return reading;
  }
  if (width == kPlainColumns) {
    reading.rows.names[3] = "doppler";
    reading.assumptions.push_back(
        fmt::format("{}: the four columns of '{}' are taken as x, y, z, Doppler", origin.string(), *points));
    return reading;
  }
  throw UnclearInput(fmt::format("{}: has {} columns without names", array.origin, width),
                     {{"columns", numbers_as_columns(array)}});
}

namespace {

/// The three columns that end in x, y and z and are the same before that; empty: none.
std::vector<std::string> axes_of(const NamedColumns& scan) {
  for (const std::string& name : scan.names()) {
    if (name.empty() || (name.back() != 'x' && name.back() != 'X')) {
      continue;
    }
    const std::string stem = name.substr(0, name.size() - 1);
    const bool is_upper = name.back() == 'X';
    const std::string* const y = find_name(scan, stem + (is_upper ? "Y" : "y"));
    const std::string* const z = find_name(scan, stem + (is_upper ? "Z" : "z"));
    if (y != nullptr && z != nullptr) {
      return {name, *y, *z};
    }
  }
  return {};
}

std::vector<Eigen::Vector3d> points_of(const std::vector<double>& x, const std::vector<double>& y,
                                       const std::vector<double>& z) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.emplace_back(x[i], y.at(i), z.at(i));
  }
  return points;
}

/// Whether a name is that of a part of a velocity in space.
bool is_part_of_velocity(const std::string& name) {
  static const std::array<std::string_view, 6> kParts = {"vx", "vy", "vz", "v_x", "v_y", "v_z"};
  return std::any_of(kParts.begin(), kParts.end(), [&](std::string_view part) { return same_text(name, part); });
}

/// What may be meant; empty: nothing that one could say.
UnclearInput::Settings likely_fields(const NamedColumns& scan, const std::map<std::string, std::string>& fields) {
  UnclearInput::Settings proposal;
  std::vector<Eigen::Vector3d> points;
  std::string array;
  const auto take_axes = [&](const std::vector<std::string>& axes) {
    points = points_of(formats::column_as_doubles(scan.read(axes[0])), formats::column_as_doubles(scan.read(axes[1])),
                       formats::column_as_doubles(scan.read(axes[2])));
  };
  const std::vector<std::string> axes = axes_of(scan);
  if (find_name(scan, "x") != nullptr && find_name(scan, "y") != nullptr && find_name(scan, "z") != nullptr) {
    take_axes({*find_name(scan, "x"), *find_name(scan, "y"), *find_name(scan, "z")});
  } else if (!axes.empty()) {
    take_axes(axes);
    proposal = {{"field.x", axes[0]}, {"field.y", axes[1]}, {"field.z", axes[2]}};
  } else {
    for (const std::string& name : scan.names()) {
      const formats::NpyArray candidate = scan.read(name);
      const std::size_t width = width_of(candidate);
      if (width >= 3 && formats::is_float(candidate.type)) {
        const std::vector<std::vector<double>> columns = columns_of_array(candidate);
        points = points_of(columns[0], columns[1], columns[2]);
        array = name;
        proposal = {{"field.points", name}};
        if (width > kPlainColumns && !has_doppler_beside(scan, fields)) {
          proposal.emplace_back("columns", proposed_columns(columns));
          return proposal;
        }
        if (width == kPlainColumns) {
          return proposal;  // the fourth is the Doppler, or there is one beside it
        }
        break;
      }
    }
  }
  if (points.empty() || has_doppler_beside(scan, fields)) {
    return points.empty() ? UnclearInput::Settings() : proposal;
  }
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  for (const std::string& name : scan.names()) {
    const formats::NpyArray column = scan.read(name);
    if (name != array && width_of(column) == 1 && column.shape.front() == points.size() &&
        formats::is_float(column.type) && std::find(axes.begin(), axes.end(), name) == axes.end() &&
        !same_text(name, "x") && !same_text(name, "y") && !same_text(name, "z") && !is_part_of_velocity(name)) {
      names.push_back(name);
      columns.push_back(formats::column_as_doubles(column));
    }
  }
  if (names.empty()) {
    return {};  // there is no Doppler, whatever the points are
  }
  proposal.emplace_back("field.doppler", names[likely_doppler(points, columns).value_or(0)]);
  return proposal;
}

}  // namespace

FieldMap map_columns(const NamedColumns& scan, const std::map<std::string, std::string>& fields,
                     const std::string& origin, const std::vector<std::string>& unusable) {
  try {
    return map_fields(scan.names(), fields, origin, unusable);
  } catch (const DataError& error) {
    UnclearInput::Settings proposal;
    try {
      proposal = likely_fields(scan, fields);
    } catch (const DataError&) {  // what cannot be read is no proposal
    }
    if (proposal.empty()) {
      throw;
    }
    throw UnclearInput(error.what(), std::move(proposal));
  }
}

}  // namespace dynamic_icp::datasets
