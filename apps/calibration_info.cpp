// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "apps/calibration_info.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/runs/calibration_file.hpp"
#include "dynamic_icp/recording/runs/run_folder.hpp"
#include "dynamic_icp/tools/figures/field_summary.hpp"
#include "dynamic_icp/tools/figures/field_text.hpp"

#include "apps/options.hpp"

namespace dynamic_icp::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "calibration";

// What the names of parts (DopplerErrorField) do not say by themselves.
constexpr std::pair<std::string_view, const char*> kMeanings[] = {
    {"cross", " by direction"},
    {"line", " one a line"},
    {"face", " one a mirror face"},
    {"velocity", " like a motion"},
};

std::string meaning_of(const std::string& part) {
  const auto* const known = std::ranges::find(kMeanings, part, [](const auto& entry) { return entry.first; });
  return known == std::end(kMeanings) ? "" : known->second;
}

/// A calibration as it stands in the file and as people see it.
struct Learned {
  window::SensorCalibration calibration;
  std::vector<figures::FieldSummary> sensors;
};

Learned read_learned(const fs::path& input) {
  std::optional<window::SensorCalibration> calibration =
      fs::is_directory(input) ? runs::read_calibration_of(input) : std::optional(runs::read_calibration(input));
  if (!calibration) {
    throw DataError(fmt::format(
        "{}: this run learned nothing of its sensor; expected calibration.yaml, which preset 'default' writes",
        input.string()));
  }
  try {
    std::vector<figures::FieldSummary> sensors = figures::field_summaries(*calibration);
    return {std::move(*calibration), std::move(sensors)};
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}: {}", input.string(), error.what()));
  }
}

std::string sensor_text(const figures::FieldSummary& sensor, const std::string& name) {
  const figures::ShownView& view = sensor.view;
  std::string text = fmt::format("\n{:<12} azimuth {:.1f} to {:.1f} deg to the right, elevation {:.1f} to {:.1f} deg\n",
                                 name, view.left_deg, view.right_deg, view.bottom_deg, view.top_deg);
  text += fmt::format("error        {:.4f} m/s RMS over the view, at most {:.4f} m/s\n", sensor.sizes.rms_mps,
                      sensor.sizes.largest_mps);
  text += fmt::format("uncertainty  {:.4f} m/s, median standard deviation over the view\n\n",
                      sensor.sizes.median_sigma_mps);
  text += fmt::format("{:<20}{:>7}{:>8}{:>8}{:>8} numbers\n", "part of it (m/s)", "scale", "RMS", "at most", "st.dev.");
  for (const figures::PartSummary& part : sensor.parts) {
    text +=
        fmt::format("{:<19}{:>8.4f}{:>8.4f}{:>8.4f}{:>8.4f}{:>8}{}\n", part.name, part.scale_mps, part.sizes.rms_mps,
                    part.sizes.largest_mps, part.sizes.median_sigma_mps, part.unknowns, meaning_of(part.name));
  }
  return text + "\n" + figures::field_text(sensor);
}

Json sizes_json(const figures::ErrorSizes& sizes) {
  return {{"rms_mps", sizes.rms_mps}, {"largest_mps", sizes.largest_mps}, {"median_sigma_mps", sizes.median_sigma_mps}};
}

Json rows_json(const Eigen::MatrixXd& values) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    rows.push_back(std::vector<double>(values.row(row).begin(), values.row(row).end()));
  }
  return rows;
}

Json sensor_json(const figures::FieldSummary& sensor) {
  Json json = {{"error", sizes_json(sensor.sizes)}, {"parts", Json::array()}};
  for (const figures::PartSummary& part : sensor.parts) {
    Json entry = {{"name", part.name}, {"numbers", part.unknowns}, {"scale_mps", part.scale_mps}};
    entry.update(sizes_json(part.sizes));
    json["parts"].push_back(entry);
  }
  json["azimuths_rad"] = sensor.cells.azimuths_rad;
  json["elevations_rad"] = sensor.cells.elevations_rad;
  json["error_mps"] = rows_json(sensor.cells.error_mps);
  json["sigma_mps"] = rows_json(sensor.cells.sigma_mps);
  return json;
}

}  // namespace

bool names_calibration(const fs::path& input) {
  std::error_code fault;
  return fs::is_directory(input, fault) ? runs::is_run_folder(input) : is_yaml_name(input.string());
}

std::string calibration_info(const fs::path& input) {
  const Learned learned = read_learned(input);
  const window::SensorCalibration& calibration = learned.calibration;
  std::string text = fmt::format("input        {}\nformat       {}: what a run learned of the Doppler's error\n",
                                 input.string(), kFormat);
  text += fmt::format("sensors      {}, with {} lines and {} mirror face{} told apart\n", learned.sensors.size(),
                      calibration.shape.lines(), calibration.shape.faces, calibration.shape.faces == 1 ? "" : "s");
  text += fmt::format("stamps       off by {:.3f} ms (standard deviation)\n", 1e3 * calibration.stamp_sigma_s);
  text += fmt::format("period       scans off by {:.3f} ms from even ones (standard deviation)\n",
                      1e3 * calibration.period_sigma_s);
  text += fmt::format("scans        {:.4f} m/s in common to all points of a scan (standard deviation)\n",
                      calibration.scan_error_mps);
  for (std::size_t k = 0; k < learned.sensors.size(); ++k) {
    text += sensor_text(learned.sensors[k], learned.sensors.size() == 1 ? "view" : fmt::format("sensor {}", k));
  }
  text += "\nPositive: the sensor measures too much.\nParts can stand for each other: the picture is their sum.\n";
  if (fs::is_directory(input)) {
    text += fmt::format("In colour and with standard deviations: dynamic-icp plot {}\n", input.string());
  }
  return text;
}

std::string calibration_json(const fs::path& input) {
  const Learned learned = read_learned(input);
  Json json = {{"input", input.string()},
               {"format", kFormat},
               {"lines", learned.calibration.shape.lines()},
               {"faces", learned.calibration.shape.faces},
               {"stamp_sigma_s", learned.calibration.stamp_sigma_s},
               {"period_sigma_s", learned.calibration.period_sigma_s},
               {"scan_error_mps", learned.calibration.scan_error_mps},
               {"sensors", Json::array()}};
  for (const figures::FieldSummary& sensor : learned.sensors) {
    json["sensors"].push_back(sensor_json(sensor));
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace dynamic_icp::apps
