// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/named_rows.hpp"

#include <algorithm>
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

/// Columns that were stated in their order, by the names that they have; empty: they are not as many.
UnclearInput::Settings stated_by_names(const std::vector<std::string>& stated, const std::vector<std::string>& names) {
  UnclearInput::Settings fields;
  for (std::size_t k = 0; k < names.size() && stated.size() == names.size(); ++k) {
    if (is_field(stated[k])) {
      fields.emplace_back("field." + stated[k], names[k]);
    }
  }
  return fields;
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
      const std::string what = fmt::format(
          "{}: its columns have names ({}): instead of what all are in their order, state which are meant by their "
          "names",
          origin.string(), fmt::join(scan.names(), ", "));
      UnclearInput::Settings proposal = stated_by_names(options.columns, scan.names());
      if (proposal.empty()) {
        throw UsageError(what);
      }
      throw UnclearInput(what, std::move(proposal));
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

/// The columns of these names; empty: not all are there.
std::vector<std::string> all_of_names(const NamedColumns& scan, const std::vector<std::string>& wanted) {
  std::vector<std::string> names;
  for (const std::string& name : wanted) {
    if (const std::string* const found = find_name(scan, name)) {
      names.push_back(*found);
    }
  }
  return names.size() == wanted.size() ? names : std::vector<std::string>();
}

/// The three columns that end or begin in x, y and z, or end in 0, 1 and 2, and are the same else; empty: none.
std::vector<std::string> axes_of(const NamedColumns& scan) {
  for (const std::string& name : scan.names()) {
    const std::string stem = name.substr(0, name.empty() ? 0 : name.size() - 1);
    const std::string tail = name.substr(name.empty() ? 0 : 1);
    std::vector<std::string> axes;
    if (name.ends_with('x') || name.ends_with('X')) {
      axes = all_of_names(scan, {name, stem + "y", stem + "z"});
    } else if (name.starts_with('x') || name.starts_with('X')) {
      axes = all_of_names(scan, {name, "y" + tail, "z" + tail});
    } else if (name.size() > 1 && name.ends_with('0')) {
      axes = all_of_names(scan, {name, stem + "1", stem + "2"});
    }
    if (!axes.empty()) {
      return axes;
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
  constexpr std::string_view kParts[] = {"vx", "vy", "vz", "v_x", "v_y", "v_z"};
  return std::ranges::any_of(kParts, [&](std::string_view part) { return same_text(name, part); });
}

/// What columns of a number each are where their names say nothing: as their numbers show, else empty.
UnclearInput::Settings fields_by_numbers(const NamedColumns& scan) {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  for (const std::string& name : scan.names()) {
    const formats::NpyArray column = scan.read(name);
    if (width_of(column) == 1 && formats::is_float(column.type) && !is_part_of_velocity(name)) {
      names.push_back(name);
      columns.push_back(formats::column_as_doubles(column));
    }
  }
  const bool are_equally_long =
      std::ranges::all_of(columns, [&](const auto& column) { return column.size() == columns.front().size(); });
  const std::optional<LikelyRow> row = are_equally_long ? likely_row(columns) : std::nullopt;
  if (!row) {
    return {};
  }
  return {{"field.x", names[row->x]},
          {"field.y", names[row->x + 1]},
          {"field.z", names[row->x + 2]},
          {"field.doppler", names[row->doppler]}};
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
  const bool are_stated = fields.contains("x") && fields.contains("y") && fields.contains("z");
  std::vector<std::string> axes;
  if (are_stated) {
    axes = all_of_names(scan, {fields.at("x"), fields.at("y"), fields.at("z")});
  }
  const std::vector<std::string> plain = all_of_names(scan, {"x", "y", "z"});
  axes = are_stated ? axes : plain.empty() ? axes_of(scan) : plain;
  if (!axes.empty()) {
    take_axes(axes);
    if (axes != plain) {
      proposal = {{"field.x", axes[0]}, {"field.y", axes[1]}, {"field.z", axes[2]}};
    }
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
  if (points.empty() && fields.empty() && !has_doppler_beside(scan, fields)) {
    return fields_by_numbers(scan);
  }
  if (points.empty() || has_doppler_beside(scan, fields)) {
    return points.empty() ? UnclearInput::Settings() : proposal;
  }
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  for (const std::string& name : scan.names()) {
    const formats::NpyArray column = scan.read(name);
    const bool is_axis = std::find(axes.begin(), axes.end(), name) != axes.end();
    if (name != array && width_of(column) == 1 && column.shape.front() == points.size() &&
        formats::is_float(column.type) && !is_axis && !is_part_of_velocity(name)) {
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
