// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/channel.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

namespace dynamic_icp::formats {
namespace {

/// Whether anything is made of the point.
bool counts(const RawScan& scan, std::size_t i) {
  return scan.points[i].allFinite() && !scan.points[i].isZero(0.0) && std::isfinite(scan.doppler[i]);
}

template <class Whole>
std::string set_whole(const RawScan& scan, std::span<const double> values, std::vector<Whole>& place) {
  constexpr auto kLast = std::numeric_limits<Whole>::max();
  std::vector<Whole> numbers(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    const bool fits = value >= 0.0 && value <= static_cast<double>(kLast) && value == std::floor(value);
    if (!fits && counts(scan, i)) {
      return fmt::format("holds {:g} at point {}, expected whole numbers from 0 to {}", value, i, kLast);
    }
    numbers[i] = fits ? static_cast<Whole>(value) : Whole{0};
  }
  place = std::move(numbers);
  return "";
}

void flag(std::span<const double> values, bool is_validity, std::vector<std::uint8_t>& is_unusable) {
  is_unusable.resize(values.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_set = std::isnan(values[i]) ? !is_validity : values[i] != 0.0;
    is_unusable[i] = is_set != is_validity ? 1 : is_unusable[i];
  }
}

}  // namespace

std::string set_channel(RawScan& scan, Channel channel, std::span<const double> values) {
  if (values.size() != scan.points.size()) {
    return fmt::format("has {} numbers, expected one for each of the {} points", values.size(), scan.points.size());
  }
  switch (channel) {
    case Channel::kSensor:
      return set_whole(scan, values, scan.channels.sensor);
    case Channel::kLine:
      return set_whole(scan, values, scan.channels.line);
    case Channel::kFace:
      return set_whole(scan, values, scan.channels.face);
    case Channel::kReturnNumber:
      return set_whole(scan, values, scan.channels.return_number);
    case Channel::kIntensity:
      scan.channels.intensity.assign(values.begin(), values.end());
      break;
    case Channel::kValid:
    case Channel::kInvalid:
      flag(values, channel == Channel::kValid, scan.is_unusable);
      break;
    case Channel::kNone:
      break;
  }
  return "";
}

void warn_of_column(RawScan& scan, const std::filesystem::path& file, std::string_view column,
                    const std::string& reason) {
  if (!reason.empty()) {
    scan.warning += fmt::format("{}{}: column '{}' is left out: it {}", scan.warning.empty() ? "" : "; ", file.string(),
                                column, reason);
  }
}

}  // namespace dynamic_icp::formats
