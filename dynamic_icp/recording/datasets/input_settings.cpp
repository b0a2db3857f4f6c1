// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/input_settings.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::array<std::string_view, 4> kColumnNames = {"x", "y", "z", "doppler"};
constexpr double kMinPeriod_s = 1e-6;
constexpr double kMaxPeriod_s = 3600.0;
constexpr double kMaxScale = 1e9;

[[noreturn]] void refuse(const std::string& name, const std::string& text, std::string_view expected) {
  throw UsageError(fmt::format("{} is '{}', expected {}", name, text, expected));
}

double number(const std::string& name, const std::string& text, double least, double most, std::string_view unit) {
  const std::optional<double> value = parse_number<double>(text);
  if (!(value && *value >= least && *value <= most)) {
    refuse(name, text, fmt::format("a number from {} to {}{}", least, most, unit));
  }
  return *value;
}

/// Whether the text is the second of two words; neither is refused.
bool is_second(const std::string& name, const std::string& text, std::string_view first, std::string_view second) {
  if (text != first && text != second) {
    refuse(name, text, fmt::format("{} or {}", first, second));
  }
  return text == second;
}

std::array<int, 4> columns(const std::string& name, const std::string& text) {
  std::array<int, 4> where = {-1, -1, -1, -1};
  std::string_view rest = text;
  for (int stored = 0; stored < 4; ++stored) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    const auto found = std::find(kColumnNames.begin(), kColumnNames.end(), rest.substr(0, end));
    if (found == kColumnNames.end()) {
      refuse(name, text, "x, y, z and doppler, each once, with commas: what the stored columns are");
    }
    where.at(static_cast<std::size_t>(found - kColumnNames.begin())) = stored;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (!rest.empty() || std::count(where.begin(), where.end(), -1) > 0) {
    refuse(name, text, "x, y, z and doppler, each once, with commas: what the stored columns are");
  }
  return where;
}

std::string stored_columns(const std::array<int, 4>& columns) {
  std::array<std::string_view, 4> stored;
  for (std::size_t k = 0; k < 4; ++k) {
    stored.at(static_cast<std::size_t>(columns[k])) = kColumnNames[k];
  }
  return fmt::format("{}", fmt::join(stored, ","));
}

}  // namespace

void set(InputSettings& settings, const std::string& name, const std::string& text) {
  Correction& correction = settings.correction;
  const auto scale = [&] { return number(name, text, 1.0 / kMaxScale, kMaxScale, ""); };
  if (name == "format") {
    settings.open.format = text;
  } else if (name.starts_with("field.")) {
    settings.open.fields[name.substr(6)] = text;
  } else if (name.starts_with("lidar.")) {
    settings.open.sensors.push_back(text);
  } else if (name.starts_with("topic.")) {
    settings.open.topics.push_back(text);
  } else if (name == "truth-topic") {
    settings.open.truth_topic = text;
  } else if (name == "period") {
    settings.open.period_s = number(name, text, kMinPeriod_s, kMaxPeriod_s, " s");
  } else if (name == "doppler-sign") {
    correction.doppler_sign = is_second(name, text, "away", "towards") ? DopplerSign::kTowards : DopplerSign::kAway;
  } else if (name == "doppler-kind") {
    correction.doppler_kind =
        is_second(name, text, "relative", "compensated") ? DopplerKind::kCompensated : DopplerKind::kRelative;
  } else if (name == "doppler-scale") {
    correction.doppler_scale = scale();
  } else if (name == "point-scale") {
    correction.point_scale = scale();
  } else if (name == "time-scale") {
    correction.time_scale = scale();
  } else if (name == "columns") {
    correction.columns = columns(name, text);
  } else {
    throw UsageError(fmt::format("unknown setting of an input '{}'", name));
  }
}

std::vector<std::pair<std::string, std::string>> texts(const InputSettings& settings) {
  std::vector<std::pair<std::string, std::string>> all;
  const auto add_number = [&](const char* name, std::optional<double> value) {
    if (value) {
      all.emplace_back(name, fmt::format("{}", *value));
    }
  };
  for (const auto& [name, column] : settings.open.fields) {
    all.emplace_back("field." + name, column);
  }
  for (std::size_t k = 0; k < settings.open.sensors.size(); ++k) {
    all.emplace_back(fmt::format("lidar.{}", k + 1), settings.open.sensors[k]);
  }
  for (std::size_t k = 0; k < settings.open.topics.size(); ++k) {
    all.emplace_back(fmt::format("topic.{}", k + 1), settings.open.topics[k]);
  }
  if (!settings.open.truth_topic.empty()) {
    all.emplace_back("truth-topic", settings.open.truth_topic);
  }
  if (settings.open.period_s != OpenOptions{}.period_s) {
    add_number("period", settings.open.period_s);
  }
  const Correction& correction = settings.correction;
  if (correction.doppler_sign) {
    all.emplace_back("doppler-sign", correction.doppler_sign == DopplerSign::kAway ? "away" : "towards");
  }
  if (correction.doppler_kind) {
    all.emplace_back("doppler-kind", correction.doppler_kind == DopplerKind::kRelative ? "relative" : "compensated");
  }
  add_number("doppler-scale", correction.doppler_scale);
  add_number("point-scale", correction.point_scale);
  add_number("time-scale", correction.time_scale);
  if (correction.columns) {
    all.emplace_back("columns", stored_columns(*correction.columns));
  }
  return all;
}

std::unique_ptr<Dataset> open_input(const std::filesystem::path& input, const InputSettings& settings) {
  check(settings.correction);
  return corrected(open_dataset(input, settings.open), settings.correction);
}

}  // namespace dynamic_icp::datasets
