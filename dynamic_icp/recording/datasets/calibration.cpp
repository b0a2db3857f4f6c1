// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/calibration.hpp"

#include <cmath>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/scan_limits.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kVehicle = "T_V_to_S";
constexpr const char* kSensors = "sensors";
constexpr const char* kMounting = "T_scan_sensor";

Eigen::Isometry3d transform_in(const json& object, const std::string& origin) {
  const json& t = object.at("translation");
  const json& q = object.at("quaternion");
  const Eigen::Vector3d translation(t.at("x").get<double>(), t.at("y").get<double>(), t.at("z").get<double>());
  const Eigen::Quaterniond rotation(q.at("w").get<double>(), q.at("x").get<double>(), q.at("y").get<double>(),
                                    q.at("z").get<double>());
  if (!(std::abs(rotation.norm() - 1.0) <= 1e-3)) {
    throw DataError(fmt::format("{}: quaternion has length {:.4f}, expected 1", origin, rotation.norm()));
  }
  return Eigen::Translation3d(translation) * rotation.normalized();
}

nlohmann::ordered_json to_json(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return {{"translation", {{"x", t.x()}, {"y", t.y()}, {"z", t.z()}}},
          {"quaternion", {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}}};
}

template <class Read>
auto read_json(const std::string& text, const std::string& origin, const Read& read) {
  try {
    return read(json::parse(text));
  } catch (const json::exception& error) {
    throw DataError(
        fmt::format("{}: expected {{\"T_V_to_S\": {{\"translation\": {{x, y, z}}, \"quaternion\": "
                    "{{w, x, y, z}}}}}}, or \"sensors\": a list of {{\"T_scan_sensor\": of the same form}}: {}",
                    origin, error.what()));
  }
}

}  // namespace

Calibration parse_calibration(const std::string& text, const std::string& origin) {
  return read_json(text, origin, [&](const json& file) {
    Calibration calibration;
    if (!file.contains(kSensors) || file.contains(kVehicle)) {
      calibration.T_vehicle_sensor = transform_in(file.at(kVehicle), origin);
    }
    if (file.contains(kSensors)) {
      const json::array_t& sensors = file.at(kSensors).get_ref<const json::array_t&>();
      if (sensors.empty() || sensors.size() > kMaxSensors) {
        throw DataError(fmt::format("{}: {} sensors, expected 1 to {}", origin, sensors.size(), kMaxSensors));
      }
      for (const json& sensor : sensors) {
        calibration.mountings.push_back(transform_in(sensor.at(kMounting), origin));
      }
    }
    return calibration;
  });
}

Calibration read_calibration(const fs::path& path) {
  return parse_calibration(formats::read_text_file(path), path.string());
}

std::optional<Calibration> find_calibration(const fs::path& folder, std::vector<std::string>& assumptions) {
  const fs::path path = folder / kCalibrationFile;
  std::error_code unreadable;
  if (!fs::exists(path, unreadable)) {
    return std::nullopt;
  }
  if (!read_json(formats::read_text_file(path), path.string(),
                 [](const json& file) { return file.contains(kVehicle) || file.contains(kSensors); })) {
    assumptions.push_back(
        fmt::format("{}: is not used: it has neither '{}' nor '{}'", path.string(), kVehicle, kSensors));
    return std::nullopt;
  }
  return read_calibration(path);
}

std::string calibration_text(const Calibration& calibration) {
  nlohmann::ordered_json file;
  if (calibration.T_vehicle_sensor) {
    file[kVehicle] = to_json(*calibration.T_vehicle_sensor);
  }
  for (const Eigen::Isometry3d& T_scan_sensor : calibration.mountings) {
    file[kSensors].push_back({{kMounting, to_json(T_scan_sensor)}});
  }
  return file.dump(2) + "\n";
}

}  // namespace dynamic_icp::datasets
