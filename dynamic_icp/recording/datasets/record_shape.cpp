// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/record_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numeric>
#include <span>
#include <system_error>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>

#include "dynamic_icp/method/base/quantile.hpp"
#include "dynamic_icp/recording/datasets/likely_doppler.hpp"
#include "dynamic_icp/recording/formats/binary_file.hpp"
#include "dynamic_icp/recording/formats/half_floats.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using formats::NpyType;

constexpr std::size_t kMinNumbers = 3;
constexpr std::size_t kMaxNumbers = 16;
constexpr std::size_t kPlain = 4;           // x, y, z, Doppler
constexpr std::size_t kLookedAt = 100'000;  // numbers
constexpr std::size_t kFilesLookedAt = 200;
constexpr std::size_t kFewestRecords = 500;
constexpr double kMaxAbsurd = 0.05;     // of the numbers
constexpr double kAsGoodAs = 1.15;      // multiples of the length are about as good
constexpr double kClearlyBetter = 0.6;  // of the jumps that the expected length has

template <class Number>
std::vector<double> numbers_of(std::string_view content) {
  std::vector<double> numbers;
  const std::size_t count = std::min(content.size() / sizeof(Number), kLookedAt);
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(static_cast<double>(formats::value_at<Number>(content, i * sizeof(Number))));
  }
  return numbers;
}

bool is_absurd(double value) {
  constexpr double kLargest = 1e7;
  constexpr double kSmallest = 1e-9;
  return std::isfinite(value) && (std::abs(value) > kLargest || (value != 0.0 && std::abs(value) < kSmallest));
}

double absurd_share(const std::vector<double>& numbers) {
  return numbers.empty() ? 1.0
                         : static_cast<double>(std::count_if(numbers.begin(), numbers.end(), is_absurd)) /
                               static_cast<double>(numbers.size());
}

/// How far numbers are apart that lie `lag` apart, on the mean, on a scale that is linear below 1 and logarithmic
/// beyond.
double jump(const std::vector<double>& scaled, std::size_t lag) {
  double sum = 0.0;
  std::size_t pairs = 0;
  for (std::size_t i = lag; i < scaled.size(); ++i) {
    const double difference = std::abs(scaled[i] - scaled[i - lag]);
    if (std::isfinite(difference)) {
      sum += difference;
      ++pairs;
    }
  }
  return pairs == 0 ? INFINITY : sum / static_cast<double>(pairs);
}

/// The numbers of one column, NaN and infinite ones left out.
std::vector<double> column_of(const std::vector<double>& scaled, std::size_t column, std::size_t stride) {
  std::vector<double> values;
  for (std::size_t i = column; i < scaled.size(); i += stride) {
    if (std::isfinite(scaled[i])) {
      values.push_back(scaled[i]);
    }
  }
  return values;
}

/// Whether two columns are of one kind: not one of them padding, and about as large.
bool are_alike(std::vector<double> one, std::vector<double> other) {
  if (one.empty() || other.empty()) {
    return true;
  }
  const auto is_constant = [](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), [&](double value) { return value == values.front(); });
  };
  return is_constant(one) == is_constant(other) && std::abs(median(std::move(one)) - median(std::move(other))) <= 1.0;
}

/// Whether records of `stride` numbers are no records of `shorter` ones that take turns, such as those of several
/// beams: then columns that lie so far apart are of one kind.
bool is_own_length(const std::vector<double>& scaled, std::size_t stride, std::size_t shorter) {
  if (stride % shorter != 0) {
    return true;
  }
  std::size_t different = 0;
  for (std::size_t k = 0; k < shorter; ++k) {
    different += are_alike(column_of(scaled, k, stride), column_of(scaled, k + shorter, stride)) ? 0 : 1;
  }
  return different >= 2;
}

std::vector<double> scaled_of(const std::vector<double>& numbers) {
  std::vector<double> scaled(numbers.size());
  std::transform(numbers.begin(), numbers.end(), scaled.begin(), [](double v) { return std::asinh(v); });
  return scaled;
}

/// The length of records that explains the numbers; 0: none stands out.
std::size_t length_of(const std::vector<double>& scaled) {
  std::array<double, kMaxNumbers + 1> jumps{};
  jumps.fill(INFINITY);
  double least = INFINITY;
  for (std::size_t lag = 1; lag <= kMaxNumbers; ++lag) {
    jumps.at(lag) = jump(scaled, lag);
    least = lag >= kMinNumbers ? std::min(least, jumps.at(lag)) : least;
  }
  for (std::size_t lag = kMinNumbers; lag <= kMaxNumbers; ++lag) {
    if (jumps.at(lag) <= kAsGoodAs * least) {
      // Records of beams that take turns repeat at several times their length.
      for (std::size_t shorter = kPlain; shorter < lag; ++shorter) {
        if (lag % shorter == 0 && !is_own_length(scaled, lag, shorter)) {
          return shorter;
        }
      }
      return jumps.at(lag) < kClearlyBetter * std::min(jumps[1], jumps[2]) ? lag : 0;
    }
  }
  return 0;
}

std::optional<RecordShape> shape_of_numbers(const std::vector<double>& numbers, NpyType type) {
  if (absurd_share(numbers) > kMaxAbsurd) {
    return std::nullopt;
  }
  const std::size_t length = length_of(scaled_of(numbers));
  if (length == 0) {
    return std::nullopt;
  }
  std::vector<std::vector<double>> columns(length);
  for (std::size_t i = 0; i + length <= numbers.size(); i += length) {
    for (std::size_t k = 0; k < length; ++k) {
      columns[k].push_back(numbers[i + k]);
    }
  }
  return RecordShape{length, type, proposed_columns(columns)};
}

struct PlainPoints {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> doppler;
};

/// Every `step`-th record of x, y, z and Doppler from `first` on; those that met nothing are left out.
PlainPoints plain_points(const std::vector<double>& numbers, std::size_t first, std::size_t step) {
  PlainPoints plain;
  for (std::size_t i = kPlain * first; i + kPlain <= numbers.size(); i += kPlain * step) {
    const Eigen::Vector3d point(numbers[i], numbers[i + 1], numbers[i + 2]);
    if (point.allFinite() && std::isfinite(numbers[i + 3]) && !point.isZero()) {
      plain.points.push_back(point);
      plain.doppler.push_back(numbers[i + 3]);
    }
  }
  return plain;
}

/// Whether these may be points that are seen at the velocity v: their Doppler says so for most, and they lie neither in
/// a plane through an axis nor, as normals do, at one distance.
bool may_be_seen_at(const Eigen::Vector3d& v, const PlainPoints& plain) {
  constexpr double kUnexplained_mps = 0.15;
  constexpr double kUnexplainedShare = 0.05;  // of the speed, whatever its unit
  constexpr double kLeastVariation = 0.01;    // of the ranges
  if (plain.points.empty()) {
    return true;  // no ray met anything: nothing speaks against it
  }
  std::vector<double> residuals;
  std::vector<double> ranges;
  for (std::size_t i = 0; i < plain.points.size(); ++i) {
    ranges.push_back(plain.points[i].norm());
    residuals.push_back(std::abs(plain.doppler[i] - v.dot(plain.points[i]) / ranges.back()));
  }
  const double range = median(ranges);
  std::transform(ranges.begin(), ranges.end(), ranges.begin(), [&](double r) { return std::abs(r - range); });
  const Eigen::Vector3d& front = plain.points.front();
  const bool is_flat = std::all_of(plain.points.begin(), plain.points.end(),
                                   [&](const Eigen::Vector3d& p) { return p.y() == front.y() || p.z() == front.z(); });
  return !is_flat && median(std::move(ranges)) > kLeastVariation * range &&
         median(std::move(residuals)) < std::max(kUnexplained_mps, kUnexplainedShare * v.norm());
}

/// Whether numbers make sense as x, y, z and Doppler though they repeat at another length, as those of several beams
/// that take turns do: one velocity explains the Doppler of each part of the points that this length tells apart.
bool is_plausible(const std::vector<double>& numbers, std::size_t length) {
  const std::size_t parts = std::lcm(length, kPlain) / kPlain;
  const PlainPoints all = plain_points(numbers, 0, 1);
  const std::optional<Eigen::Vector3d> v = likely_velocity(all.points, all.doppler);
  for (std::size_t part = 0; v && part < parts; ++part) {
    if (!may_be_seen_at(*v, plain_points(numbers, part, parts))) {
      return false;
    }
  }
  return v.has_value();
}

std::uintmax_t size_of_file(const fs::path& file) {
  std::error_code fault;
  const std::uintmax_t size = fs::file_size(file, fault);
  return fault ? 0 : size;
}

/// The sizes of files from all over the recording that are not empty.
std::vector<std::uintmax_t> sizes_of(const std::vector<fs::path>& files) {
  std::vector<std::uintmax_t> sizes;
  for (std::size_t i = 0; i < files.size(); i += 1 + files.size() / kFilesLookedAt) {
    if (const std::uintmax_t size = size_of_file(files[i]); size > 0) {
      sizes.push_back(size);
    }
  }
  return sizes;
}

std::size_t multiples(const std::vector<std::uintmax_t>& sizes, std::size_t bytes) {
  return static_cast<std::size_t>(
      std::count_if(sizes.begin(), sizes.end(), [&](std::uintmax_t size) { return size % bytes == 0; }));
}

/// The begin of the first file that is not empty; empty where there is none, or it cannot be read: its reader says so.
std::string first_content(const std::vector<fs::path>& files) {
  const auto first =
      std::find_if(files.begin(), files.end(), [](const fs::path& file) { return size_of_file(file) > 0; });
  std::error_code fault;
  if (first == files.end() || !fs::is_regular_file(*first, fault)) {
    return "";
  }
  std::string content(std::min<std::uintmax_t>(size_of_file(*first), kLookedAt * sizeof(double)), '\0');
  std::ifstream file(*first, std::ios::binary);
  file.read(content.data(), static_cast<std::streamsize>(content.size()));
  content.resize(static_cast<std::size_t>(file.gcount()));
  return content;
}

std::string_view type_name(NpyType type) { return type == NpyType::kFloat64 ? "float64" : "float32"; }

UnclearInput unclear(const std::vector<fs::path>& files, const RecordShape& shape, const std::string& instead) {
  const std::vector<std::uintmax_t> sizes = sizes_of(files);
  const std::string sizes_say = sizes.size() == 1
                                    ? fmt::format("its size is a multiple of {} bytes", shape.bytes())
                                    : fmt::format("the sizes of {} of {} files are multiples of {} bytes",
                                                  multiples(sizes, shape.bytes()), sizes.size(), shape.bytes());
  UnclearInput::Settings proposal = {{"columns", shape.columns}};
  if (shape.type != NpyType::kFloat32) {
    proposal.emplace_back("dtype", type_name(shape.type));
  }
  return {fmt::format("{}: looks like records of {} {} a point{}: {}, and the numbers repeat at that length",
                      files.front().string(), shape.numbers, type_name(shape.type), instead, sizes_say),
          std::move(proposal)};
}

}  // namespace

std::optional<RecordShape> shape_of(std::string_view content) {
  const std::vector<double> numbers = numbers_of<float>(content);
  if (std::optional<RecordShape> shape = shape_of_numbers(numbers, NpyType::kFloat32)) {
    return shape;
  }
  if (absurd_share(numbers) <= kMaxAbsurd) {
    return std::nullopt;  // float64 are no float32: half of each is noise
  }
  return shape_of_numbers(numbers_of<double>(content), NpyType::kFloat64);
}

std::optional<UnclearInput> other_shape(const std::vector<fs::path>& files, std::size_t numbers,
                                        std::optional<NpyType> type) {
  const std::vector<std::uintmax_t> sizes = sizes_of(files);
  const std::string content = first_content(files);
  const std::optional<RecordShape> shape = shape_of(content);
  if (!shape || (shape->numbers == numbers && shape->type == type) || shape->numbers <= kMinNumbers) {
    return std::nullopt;
  }
  const std::size_t expected_bytes = numbers * (type ? formats::size_of(*type) : formats::kHalfBytes);
  const std::size_t as_expected = multiples(sizes, expected_bytes);
  const std::size_t as_seen = multiples(sizes, shape->bytes());
  if (as_expected == sizes.size() && shape->type == type && content.size() < kFewestRecords * expected_bytes) {
    return std::nullopt;  // so few numbers may look like anything
  }
  if (as_expected == sizes.size() && numbers == kPlain && type == NpyType::kFloat32 &&
      is_plausible(numbers_of<float>(content), shape->bytes() / sizeof(float))) {
    return std::nullopt;
  }
  // A scan that was cut short, or a few, are no reason to doubt.
  if (10 * as_seen < 9 * sizes.size() || as_seen < as_expected) {
    return std::nullopt;
  }
  const std::string instead = as_expected == sizes.size()
                                  ? fmt::format(" rather than of {}", numbers)
                                  : fmt::format(", not of {} ({} bytes)", numbers, expected_bytes);
  return unclear(files, *shape, shape->type == type ? instead : "");
}

bool sizes_fit(const std::vector<fs::path>& files, std::size_t bytes) {
  const std::vector<std::uintmax_t> sizes = sizes_of(files);
  return multiples(sizes, bytes) == sizes.size();
}

std::optional<UnclearInput> likely_shape(const std::vector<fs::path>& files) {
  const std::optional<RecordShape> shape = shape_of(first_content(files));
  return shape && shape->numbers > kMinNumbers ? std::optional(unclear(files, *shape, "")) : std::nullopt;
}

}  // namespace dynamic_icp::datasets
