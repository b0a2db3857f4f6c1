// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/input_options.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"

namespace dynamic_icp::apps {
namespace {

void set_option(datasets::InputSettings& settings, const std::string& name, const std::string& text) {
  try {
    datasets::set(settings, name, text);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("--{}", error.what()));  // the message begins with the name of the setting
  }
}

void add(CLI::App& command, datasets::InputSettings& settings, const std::string& name, const char* type,
         const std::string& description) {
  command
      .add_option_function<std::string>(
          "--" + name, [&settings, name](const std::string& text) { set_option(settings, name, text); }, description)
      ->type_name(type);
}

void set_field(datasets::InputSettings& settings, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw UsageError(fmt::format("--field is '{}', expected NAME=COLUMN, e.g. doppler=velocity", text));
  }
  datasets::set(settings, "field." + text.substr(0, equals), text.substr(equals + 1));
}

void add_repeatable(CLI::App& command, const char* name, const char* type, const char* description,
                    const std::function<void(const std::string&)>& take) {
  command
      .add_option_function<std::vector<std::string>>(
          name,
          [take](const std::vector<std::string>& all) {
            for (const std::string& text : all) {
              take(text);
            }
          },
          description)
      ->type_name(type)
      ->allow_extra_args(false)  // what follows the value is another argument
      ->take_all();
}

/// One word of a command line, quoted where a shell would take it for more.
std::string as_word(const std::string& text) {
  const bool is_plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-./,:=+@%").find(static_cast<char>(c)) != std::string_view::npos;
  });
  if (is_plain && !text.empty()) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

}  // namespace

void add_input_options(CLI::App& command, datasets::InputSettings& settings) {
  add(command, settings, "format", "NAME",
      fmt::format("Layout of the recording: auto, {} (default auto)", fmt::join(datasets::known_formats(), ", ")));
  add_repeatable(
      command, "--field", "NAME=COLUMN",
      "The column that holds x, y, z, doppler or time, or azimuth_deg, elevation_deg (or _rad) and range, or the array "
      "that holds the points, where columns have names; repeatable",
      [&settings](const std::string& text) { set_field(settings, text); });
  add_repeatable(command, "--lidar", "NAME",
                 "Sensor to take of a recording with several; repeatable (default: the layout's choice)",
                 [&settings](const std::string& text) { datasets::set(settings, "lidar.", text); });
  add_repeatable(command, "--topic", "NAME",
                 "Topic of a bag to read; repeatable for the sensors of a rig (default: the one with a Doppler)",
                 [&settings](const std::string& text) { datasets::set(settings, "topic.", text); });
  add(command, settings, "truth-topic", "NAME",
      "Topic of a bag whose poses are ground truth, or PARENT>CHILD of its transforms (default: one named so)");
  add(command, settings, "period", "S",
      fmt::format("Time from scan to scan where the recording has no times (default {} s)", settings.open.period_s));
  add(command, settings, "dtype", "TYPE",
      fmt::format("Type of the numbers of records in *.bin: {} (default float32)",
                  fmt::join(datasets::record_types(), ", ")));
  add(command, settings, "time-scale", "F",
      "Factor for the time since the first scan and the times of points (default 1)");
  add_correction_options(command, settings);
}

void add_correction_options(CLI::App& command, datasets::InputSettings& settings) {
  add(command, settings, "doppler-sign", "SIGN",
      "What a positive Doppler means: away or towards (the sensor) (default away)");
  add(command, settings, "doppler-kind", "KIND",
      "relative (raw) or compensated (ego motion removed) Doppler (default: what the layout says)");
  add(command, settings, "doppler-scale", "F", "Factor that makes the Doppler m/s, e.g. 0.001 for mm/s (default 1)");
  add(command, settings, "point-scale", "F", "Factor that makes coordinates m, e.g. 0.001 for mm (default 1)");
  add(command, settings, "columns", "LIST",
      "What the stored columns are: x,y,z,doppler in their order; or what all numbers of a record, row or array "
      "without "
      "names are, with _ for what is not used, e.g. x,y,z,_,doppler; azimuth_deg,elevation_deg,range (or _rad) in "
      "place "
      "of x,y,z (default x,y,z,doppler)");
}

std::string as_options(const std::vector<std::pair<std::string, std::string>>& settings) {
  std::string options;
  for (const auto& [name, text] : settings) {
    const std::size_t point = name.find('.');  // "field.doppler", "topic.1"
    const std::string kind = name.substr(0, point);
    const std::string value = kind == "field" ? fmt::format("{}={}", name.substr(point + 1), text) : text;
    options += fmt::format("{}--{} {}", options.empty() ? "" : " ", kind, as_word(value));
  }
  return options;
}

std::string with_options(const datasets::UnclearInput& error) {
  std::string text = with_options(error.what(), error.proposal());
  const bool is_list = text.find('\n') != std::string::npos;
  for (const datasets::UnclearInput::Settings& other : error.others()) {
    text += fmt::format("{} {}", is_list ? "\nor" : ", or with", as_options(other));
  }
  return text;
}

std::string with_options(const std::string& what, const datasets::UnclearInput::Settings& proposal) {
  if (proposal.empty()) {
    return what;
  }
  const bool is_list = what.find('\n') != std::string::npos;
  return fmt::format("{}{} {}", what, is_list ? "\nfor instance" : "; state it, e.g. with", as_options(proposal));
}

std::string fixing_options(const diagnosis::Finding& finding, const datasets::InputSettings& settings) {
  if (finding.needs_doppler_column) {
    return as_options(datasets::texts_of_doppler(finding.doppler_column, settings));
  }
  return as_options(datasets::texts_of_fix(finding.fix, settings));
}

}  // namespace dynamic_icp::apps
