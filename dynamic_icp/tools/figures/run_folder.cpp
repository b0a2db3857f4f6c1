// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/figures/run_folder.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/tum.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/tools/drawing/markup.hpp"

namespace dynamic_icp::figures {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Eigen::Vector3d unknown_vector() { return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()); }

/// A JSON object with its place in a file; every getter throws a DataError that names the place and the key.
class Row {
 public:
  Row(const Json& object, std::string place) : object_(object), place_(std::move(place)) {
    if (!object_.is_object()) {
      throw DataError(fmt::format("{}: expected a JSON object", place_));
    }
  }

  [[nodiscard]] bool has(const char* key) const { return object_.contains(key); }

  [[nodiscard]] const Json& get(const char* key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) {
      throw DataError(fmt::format("{}: the key \"{}\" is missing", place_, key));
    }
    return *found;
  }

  [[nodiscard]] double number(const char* key) const { return number(get(key), key); }

  [[nodiscard]] std::int64_t integer(const char* key) const {
    const Json& value = get(key);
    if (!value.is_number_integer()) {
      fail(key, "a whole number");
    }
    return value.get<std::int64_t>();
  }

  [[nodiscard]] bool truth(const char* key) const {
    const Json& value = get(key);
    if (!value.is_boolean()) {
      fail(key, "true or false");
    }
    return value.get<bool>();
  }

  [[nodiscard]] std::string text(const char* key) const {
    const Json& value = get(key);
    if (!value.is_string()) {
      fail(key, "a text");
    }
    return value.get<std::string>();
  }

  [[nodiscard]] Eigen::Vector3d vector(const char* key) const {
    const Json& value = get(key);
    if (value.is_null()) {
      return unknown_vector();
    }
    return numbers<3>(key);
  }

  template <int kSize>
  [[nodiscard]] Eigen::Matrix<double, kSize, 1> numbers(const char* key) const {
    const Json& value = get(key);
    if (!value.is_array() || value.size() != kSize) {
      fail(key, fmt::format("a list of {} numbers", kSize));
    }
    Eigen::Matrix<double, kSize, 1> numbers;
    for (int k = 0; k < kSize; ++k) {
      numbers[k] = number(value[static_cast<std::size_t>(k)], key);
    }
    return numbers;
  }

  [[nodiscard]] const Json& list(const char* key) const {
    const Json& value = get(key);
    if (!value.is_array()) {
      fail(key, "a list");
    }
    return value;
  }

  [[nodiscard]] Row object(const char* key) const { return part(key, get(key)); }

  /// A part of the value of a key, which must be an object.
  [[nodiscard]] Row part(const char* key, const Json& value) const {
    if (!value.is_object()) {
      fail(key, "a JSON object");
    }
    return {value, fmt::format("{}, \"{}\"", place_, key)};
  }

  [[nodiscard]] double number(const Json& value, const char* key) const {
    if (value.is_null()) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (!value.is_number()) {
      fail(key, "a number");
    }
    return value.get<double>();
  }

  [[noreturn]] void fail(const char* key, std::string_view expected) const {
    throw DataError(fmt::format("{}: the value of \"{}\" is not {}", place_, key, expected));
  }

 private:
  const Json& object_;
  std::string place_;
};

Json parse(std::string_view text, const std::string& place) {
  // The library takes nested values apart by recursion: refuse what no run writes before it gets there.
  constexpr int kDeepest = 16;
  const auto refuse_deep = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) {
      throw DataError(fmt::format("{}: JSON nested deeper than {} levels", place, kDeepest));
    }
    return true;
  };
  try {
    return Json::parse(text, refuse_deep);
  } catch (const Json::exception& error) {
    throw DataError(fmt::format("{}: not a complete JSON object; was the run interrupted? ({})", place, error.what()));
  }
}

void require_file(const fs::path& path) {
  if (!fs::exists(path)) {
    throw DataError(fmt::format("{}: no such file; expected the folder of a finished run", path.string()));
  }
}

std::string read_file_of_run(const fs::path& path) {
  require_file(path);
  return formats::read_text_file(path);
}

/// Calls use(object, place) for each line that is not empty.
template <class Use>
void for_each_line(const fs::path& path, const Use& use) {
  const std::string content = read_file_of_run(path);
  std::string_view rest = content;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (!text.empty()) {
      const std::string place = fmt::format("{}, line {}", path.string(), line);
      const Json object = parse(text, place);
      use(Row(object, place));
    }
  }
}

/// The ego velocity, NaN where it could not be estimated and zeros stand in the file.
Eigen::Vector3d ego_velocity(const Row& row) {
  const std::string status = row.has("ego_velocity_status") ? row.text("ego_velocity_status") : "converged";
  const bool estimated = status == "converged" || status == "iteration_limit" || status == "from_motion";
  return estimated ? row.vector("ego_velocity") : unknown_vector();
}

/// What runs of earlier versions do not hold is unknown.
double number_if_any(const Row& row, const char* key) {
  return row.has(key) ? row.number(key) : std::numeric_limits<double>::quiet_NaN();
}

std::optional<TwistRow> twist(const Row& row) {
  if (!row.has("twist") || row.get("twist").is_null()) {
    return std::nullopt;
  }
  const Row twist = row.object("twist");
  return TwistRow{.angular = twist.vector("angular"), .linear = twist.vector("linear")};
}

std::vector<Vector6d> unknown_directions(const Row& row) {
  std::vector<Vector6d> directions;
  if (row.has("degenerate")) {
    for (const Json& entry : row.list("degenerate")) {
      directions.push_back(row.part("degenerate", entry).numbers<6>("direction"));
    }
  }
  return directions;
}

FrameRow frame_row(const Row& row) {
  FrameRow frame;
  frame.index = static_cast<std::size_t>(row.integer("index"));
  frame.points = row.number("points");
  frame.points_used = row.number("points_used");
  frame.ego_velocity = ego_velocity(row);
  frame.dynamic_candidates = row.number("dynamic_candidates");
  frame.dynamic_clustered = row.number("dynamic_clustered");
  frame.dynamic_refined = row.number("dynamic_refined");
  frame.iterations = row.number("iterations");
  frame.converged = row.truth("converged");
  frame.status = row.text("status");
  frame.reason = row.text(row.has("reason") ? "reason" : "status");
  frame.fitness = row.number("fitness");
  frame.inlier_rmse = row.number("inlier_rmse");
  frame.information_ratio = number_if_any(row, "information_ratio");
  frame.unknown_directions = unknown_directions(row);
  frame.twist = twist(row);
  frame.doppler_bias = row.has("doppler_bias") ? row.number("doppler_bias") : 0.0;
  const Json& stages = row.get("ms");
  if (!stages.is_object()) {
    row.fail("ms", "an object of milliseconds per stage");
  }
  for (const auto& [stage, value] : stages.items()) {
    frame.milliseconds.emplace_back(stage, row.number(value, "ms"));
  }
  return frame;
}

/// The yaw of boxes that stand upright: their quaternion turns about z alone.
std::optional<ObjectRow::Box> box(const Row& row) {
  if (!row.has("box")) {
    return std::nullopt;
  }
  const Row box = row.object("box");
  const Eigen::Vector4d xyzw = box.numbers<4>("orientation_xyzw");
  return ObjectRow::Box{
      .centre = box.vector("center"), .size = box.vector("size"), .yaw_rad = 2.0 * std::atan2(xyzw.z(), xyzw.w())};
}

ObjectRow object_row(const Row& row) {
  return {.id = row.integer("id"),
          .velocity = row.vector("velocity"),
          .centroid = row.vector("centroid"),
          .extent = row.vector("extent"),
          .points = row.number("points"),
          .box = box(row)};
}

std::vector<ObjectRow> object_rows(const Row& row, const std::string& file) {
  std::vector<ObjectRow> objects;
  for (const Json& object : row.list("objects")) {
    objects.push_back(object_row(Row(object, fmt::format("{}, scan {}, an object", file, row.integer("index")))));
  }
  return objects;
}

Value value_of(const Json& json) {
  if (json.is_null()) {
    return {};
  }
  if (json.is_boolean()) {
    return json.get<bool>();
  }
  if (json.is_number()) {
    return json.get<double>();
  }
  return json.is_string() ? json.get<std::string>() : json.dump();
}

void append_settings(Settings& settings, const std::string& prefix, const Json& object) {
  for (const auto& [key, value] : object.items()) {
    if (value.is_object()) {
      append_settings(settings, prefix + key + ".", value);
    } else {
      settings.emplace_back(prefix + key, value_of(value));
    }
  }
}

void append_texts(std::vector<std::string>& texts, const Json& list) {
  for (const Json& text : list) {
    texts.push_back(text.is_string() ? text.get<std::string>() : text.dump());
  }
}

/// The object that makes up a file.
Json read_object(const fs::path& path) {
  Json object = parse(read_file_of_run(path), path.string());
  if (!object.is_object()) {
    throw DataError(fmt::format("{}: expected a JSON object", path.string()));
  }
  return object;
}

void check_count(const fs::path& file, const char* what, std::size_t count, std::size_t frames) {
  if (count != frames) {
    throw DataError(fmt::format("{}: {} {}, but frames.jsonl holds {} scans; was the run interrupted?", file.string(),
                                count, what, frames));
  }
}

fs::path labels_file(const RunFiles& run, std::size_t frame) {
  return run.folder / "labels" / fmt::format("{:05}.bin", run.frames[frame].index + 1);
}

}  // namespace

std::string text_of(const Settings& settings, std::string_view key) {
  for (const auto& [name, value] : settings) {
    if (name == key) {
      if (const std::string* text = std::get_if<std::string>(&value)) {
        return *text;
      }
      if (const double* number = std::get_if<double>(&value)) {
        return fmt::format("{}", *number);
      }
      if (const bool* truth = std::get_if<bool>(&value)) {
        return *truth ? "true" : "false";
      }
    }
  }
  return {};
}

double RunFiles::seconds(std::size_t frame) const {
  return seconds_between(trajectory.front().stamp, trajectory[frame].stamp);
}

RunFiles read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw DataError(fmt::format("{}: no such folder; expected the folder of a run", folder.string()));
  }
  RunFiles run;
  run.folder = folder;
  Json about = read_object(folder / "run.json");
  if (const auto configuration = about.find("configuration"); configuration != about.end()) {
    append_settings(run.configuration, "", *configuration);
    about.erase("configuration");
  }
  for (const char* key : {"assumptions", "warnings"}) {
    append_texts(run.warnings, about.value(key, Json::array()));
    about.erase(key);
  }
  append_settings(run.run, "", about);
  append_settings(run.summary, "", read_object(folder / "summary.json"));

  for_each_line(folder / "frames.jsonl", [&](const Row& row) { run.frames.push_back(frame_row(row)); });
  const fs::path objects = folder / "objects.jsonl";
  for_each_line(objects, [&](const Row& row) { run.objects.push_back(object_rows(row, objects.string())); });
  check_count(objects, "lines", run.objects.size(), run.frames.size());
  const fs::path trajectory = folder / "trajectory.tum";
  require_file(trajectory);
  if (!run.frames.empty() || fs::file_size(trajectory) > 0) {
    run.trajectory = formats::read_tum(trajectory).trajectory;
  }
  check_count(trajectory, "poses", run.trajectory.size(), run.frames.size());
  return run;
}

bool lacks_labels(const RunFiles& run, std::size_t frame) {
  return fs::exists(run.folder / "labels") && !fs::exists(labels_file(run, frame));
}

std::optional<std::vector<std::int32_t>> read_labels(const RunFiles& run, std::size_t frame, std::size_t points) {
  const fs::path path = labels_file(run, frame);
  if (!fs::exists(path)) {
    return std::nullopt;
  }
  const std::string bytes = formats::read_whole_file(path);
  if (bytes.size() != 4 * points) {
    throw DataError(fmt::format("{}: {} bytes, expected {}: int32 for each of the {} points of the scan", path.string(),
                                bytes.size(), 4 * points, points));
  }
  std::vector<std::int32_t> labels(points);
  for (std::size_t k = 0; k < points; ++k) {
    std::uint32_t bits = 0;  // little-endian in the file, whatever the machine
    for (std::size_t b = 0; b < 4; ++b) {
      bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[4 * k + b])) << (8 * b);
    }
    labels[k] = static_cast<std::int32_t>(bits);
  }
  return labels;
}

}  // namespace dynamic_icp::figures
