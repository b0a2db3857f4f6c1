// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/calibration_file.hpp"

#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/yaml_map.hpp"

namespace dynamic_icp::runs {
namespace {

using window::FieldShape;
using window::SensorCalibration;

constexpr formats::Limits kAny{-1e12, 1e12};
constexpr formats::Limits kNotNegative{0.0, 1e12};
constexpr formats::Limits kAzimuth_rad{-2.0 * std::numbers::pi, 2.0 * std::numbers::pi};
constexpr formats::Limits kSpan_rad{0.01, 2.0 * std::numbers::pi + 0.1};
constexpr formats::Limits kError_mps{-100.0, 100.0};
constexpr formats::Limits kScale_mps{1e-6, 10.0};
constexpr formats::Limits kSigma_s{1e-6, 0.1};

// A text that reads back as the same numbers.
std::string list_of(const std::vector<double>& values) { return fmt::format("[{}]", fmt::join(values, ", ")); }

}  // namespace

std::string calibration_text(const SensorCalibration& calibration) {
  std::string text =
      "# What preset default learned of a sensor: errors of its Doppler (m/s, to be subtracted from what it "
      "measures),\n"
      "# their standard deviations, and how they depend on each other. Another recording of this sensor may begin with "
      "it.\n"
      "version: 1\n";
  const FieldShape& shape = calibration.shape;
  text += fmt::format("line_elevations_rad: {}\nfaces: {}\nintensity_mean: {}\nintensity_scale: {}\n",
                      list_of(shape.line_elevations_rad), shape.faces, shape.intensity_mean, shape.intensity_scale);
  text += fmt::format("stamp_sigma_s: {}\nperiod_sigma_s: {}\nscan_error_mps: {}\n", calibration.stamp_sigma_s,
                      calibration.period_sigma_s, calibration.scan_error_mps);
  text += "sensors:  # directions in rad\n";
  for (const FieldShape::View& view : shape.views) {
    text += fmt::format("  - {{azimuth_first: {}, azimuth_span: {}, elevation_first: {}, elevation_span: {}}}\n",
                        view.azimuth_first, view.azimuth_span, view.elevation_first, view.elevation_span);
  }
  text += "parts:\n";
  for (const SensorCalibration::Part& part : calibration.parts) {
    text += fmt::format("  - name: {}\n    scale_mps: {}\n    error_mps: {}\n    sigma_mps: {}\n", part.name,
                        part.scale_mps, list_of(part.error_mps), list_of(part.sigma_mps));
  }
  text += fmt::format("gradient: {}\ninformation:  # (s/m)^2, lower triangle\n", list_of(calibration.gradient));
  for (const std::vector<double>& row : calibration.information) {
    text += fmt::format("  - {{row: {}}}\n", list_of(row));
  }
  return text;
}

SensorCalibration read_calibration(const std::filesystem::path& path) {
  const formats::YamlMap map = formats::YamlMap::load(path);
  if (!map.has("line_elevations_rad")) {  // other files of a run have a version, too
    throw UsageError(fmt::format("{}: has no line_elevations_rad: expected calibration.yaml of a run", path.string()));
  }
  SensorCalibration result;
  static_cast<void>(map.whole_number("version", {1, 1}));
  FieldShape& shape = result.shape;
  shape.line_elevations_rad = map.numbers_or_none("line_elevations_rad", kAzimuth_rad);
  shape.faces = static_cast<std::size_t>(map.whole_number("faces", {1, 256}));
  shape.intensity_mean = map.number("intensity_mean", kAny);
  shape.intensity_scale = map.number("intensity_scale", kNotNegative);
  result.stamp_sigma_s = map.number("stamp_sigma_s", kSigma_s);
  result.period_sigma_s = map.number("period_sigma_s", kSigma_s, window::kUnknownPeriod_s);  // not in older files
  result.scan_error_mps = map.number("scan_error_mps", kScale_mps);
  for (const formats::YamlMap& sensor : map.list("sensors")) {
    shape.views.push_back({sensor.number("azimuth_first", kAzimuth_rad), sensor.number("azimuth_span", kSpan_rad),
                           sensor.number("elevation_first", kAzimuth_rad), sensor.number("elevation_span", kSpan_rad)});
  }
  if (shape.views.empty()) {
    map.fail("sensors", "has no sensor, expected one at least");
  }
  for (const formats::YamlMap& part : map.list("parts")) {
    SensorCalibration::Part read{
        part.text("name"), part.number("scale_mps", kScale_mps), part.numbers("error_mps", 0, kError_mps), {}};
    read.sigma_mps = part.numbers("sigma_mps", read.error_mps.size(), kNotNegative);
    result.parts.push_back(std::move(read));
  }
  result.gradient = map.numbers("gradient", 0, kAny);
  for (const formats::YamlMap& row : map.list("information")) {
    result.information.push_back(row.numbers("row", result.information.size() + 1, kAny));
  }
  map.finish();
  return result;
}

std::optional<window::SensorCalibration> read_calibration_of(const std::filesystem::path& run_folder) {
  const std::filesystem::path path = run_folder / "calibration.yaml";
  return std::filesystem::exists(path) ? std::optional(read_calibration(path)) : std::nullopt;
}

}  // namespace dynamic_icp::runs
