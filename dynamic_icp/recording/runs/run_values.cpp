// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/runs/run_values.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "dynamic_icp/recording/formats/json_row.hpp"

namespace dynamic_icp::runs {
namespace {

using Json = formats::JsonRow::Json;

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

/// Takes a list of texts out of an object; empty where there is none.
std::vector<std::string> take_texts(Json& object, const char* key) {
  std::vector<std::string> texts;
  for (const Json& text : object.value(key, Json::array())) {
    texts.push_back(text.is_string() ? text.get<std::string>() : text.dump());
  }
  object.erase(key);
  return texts;
}

const Value* find(const Settings& settings, std::string_view key) {
  const auto found = std::ranges::find(settings, key, &Settings::value_type::first);
  return found == settings.end() ? nullptr : &found->second;
}

}  // namespace

std::string text_of(const Settings& settings, std::string_view key) {
  const Value* value = find(settings, key);
  if (value == nullptr || std::holds_alternative<std::monostate>(*value)) {
    return {};
  }
  if (const double* number = std::get_if<double>(value)) {
    return fmt::format("{}", *number);
  }
  if (const bool* truth = std::get_if<bool>(value)) {
    return *truth ? "true" : "false";
  }
  return std::get<std::string>(*value);
}

std::optional<double> number_of(const Settings& settings, std::string_view key) {
  const Value* value = find(settings, key);
  const double* number = value != nullptr ? std::get_if<double>(value) : nullptr;
  return number != nullptr ? std::optional(*number) : std::nullopt;
}

Settings read_summary(const std::filesystem::path& path) {
  Settings summary;
  append_settings(summary, "", formats::read_json_object(path));
  return summary;
}

RunRecord read_run_json(const std::filesystem::path& path) {
  Json about = formats::read_json_object(path);
  RunRecord record;
  if (const auto configuration = about.find("configuration"); configuration != about.end()) {
    append_settings(record.configuration, "", *configuration);
    about.erase("configuration");
  }
  record.assumptions = take_texts(about, "assumptions");
  record.warnings = take_texts(about, "warnings");
  append_settings(record.about, "", about);
  return record;
}

}  // namespace dynamic_icp::runs
