// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/json_row.hpp"

#include <limits>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"

namespace dynamic_icp::formats {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Json parse(std::string_view text, const std::string& place) {
  // The library takes nested values apart by recursion: refuse what no file of ours holds before it gets there.
  constexpr int kMaxDepth = 16;
  const auto refuse_deep = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxDepth) {
      throw DataError(fmt::format("{}: JSON nested deeper than {} levels", place, kMaxDepth));
    }
    return true;
  };
  try {
    return Json::parse(text, refuse_deep);
  } catch (const Json::exception& error) {
    throw DataError(
        fmt::format("{}: not a complete JSON object; was its writer interrupted? ({})", place, error.what()));
  }
}

}  // namespace

JsonRow::JsonRow(const Json& object, std::string place) : object_(object), place_(std::move(place)) {
  if (!object_.is_object()) {
    throw DataError(fmt::format("{}: expected a JSON object", place_));
  }
}

const Json& JsonRow::get(const char* key) const {
  const auto found = object_.find(key);
  if (found == object_.end()) {
    throw DataError(fmt::format("{}: the key \"{}\" is missing", place_, key));
  }
  return *found;
}

const Json& JsonRow::get(const char* key, bool (Json::*is_kind)() const noexcept, std::string_view expected) const {
  const Json& value = get(key);
  if (!(value.*is_kind)()) {
    fail(key, expected);
  }
  return value;
}

double JsonRow::number(const Json& value, const char* key) const {
  if (value.is_null()) {
    return kNaN;
  }
  if (!value.is_number()) {
    fail(key, "a number");
  }
  return value.get<double>();
}

Eigen::Vector3d JsonRow::vector(const char* key) const {
  return get(key).is_null() ? Eigen::Vector3d::Constant(kNaN) : numbers<3>(key);
}

JsonRow JsonRow::part(const char* key, const Json& value) const {
  if (!value.is_object()) {
    fail(key, "a JSON object");
  }
  return {value, fmt::format("{}, \"{}\"", place_, key)};
}

Eigen::Vector3d JsonRow::finite_vector(const char* key) const {
  Eigen::Vector3d vector = numbers<3>(key);
  if (!vector.allFinite()) {
    fail(key, "a list of 3 numbers");
  }
  return vector;
}

void JsonRow::fail(const char* key, std::string_view expected) const {
  throw DataError(fmt::format("{}: the value of \"{}\" is not {}", place_, key, expected));
}

void JsonRow::check_size(const char* key, std::size_t size) const {
  if (!get(key).is_array() || get(key).size() != size) {
    fail(key, fmt::format("a list of {} numbers", size));
  }
}

Json read_json_object(const std::filesystem::path& path) {
  Json object = parse(read_text_file(path), path.string());
  if (!object.is_object()) {
    throw DataError(fmt::format("{}: expected a JSON object", path.string()));
  }
  return object;
}

void for_each_json_line(const std::filesystem::path& path, const std::function<void(const JsonRow&)>& use) {
  for_each_text_line(path, [&](std::string_view text, std::size_t line) {
    if (!text.empty()) {
      const std::string place = fmt::format("{}, line {}", path.string(), line);
      const Json object = parse(text, place);
      use(JsonRow(object, place));
    }
  });
}

}  // namespace dynamic_icp::formats
