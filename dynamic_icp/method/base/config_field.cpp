// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/config_field.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"

namespace dynamic_icp {
namespace {

[[noreturn]] void throw_unknown_key(const ConfigFields& fields, std::string_view key) {
  std::vector<std::string> keys;
  for (const ConfigField& field : fields) {
    keys.push_back(field.key);
  }
  const std::string_view nearest = nearest_key(key, keys);
  const auto meant = std::find_if(fields.begin(), fields.end(), [&](const ConfigField& f) { return f.key == nearest; });
  if (meant == fields.end()) {
    throw UsageError(fmt::format("unknown configuration key '{}'", key));
  }
  throw UsageError(
      fmt::format("unknown configuration key '{}'; did you mean '{}' ({})?", key, meant->key, range_text(*meant)));
}

[[noreturn]] void throw_bad_value(const ConfigField& field, std::string_view text) {
  throw UsageError(fmt::format("configuration key '{}' is '{}', expected {}", field.key, text, range_text(field)));
}

bool in_range(const ConfigField& field, double value) {
  return std::isfinite(value) && value >= field.minimum && value <= field.maximum;
}

}  // namespace

void append_fields(ConfigFields& into, std::string_view prefix, ConfigFields fields) {
  for (ConfigField& field : fields) {
    field.key = fmt::format("{}.{}", prefix, field.key);
    into.push_back(std::move(field));
  }
}

void set_field(const ConfigFields& fields, std::string_view key, std::string_view text) {
  const auto field = std::find_if(fields.begin(), fields.end(), [&](const ConfigField& f) { return f.key == key; });
  if (field == fields.end()) {
    throw_unknown_key(fields, key);
  }
  if (bool* const* target = std::get_if<bool*>(&field->value)) {
    if (text != "true" && text != "false") {
      throw_bad_value(*field, text);
    }
    **target = text == "true";
  } else if (int* const* int_target = std::get_if<int*>(&field->value)) {
    const std::optional<int> number = parse_number<int>(text);
    if (!number || !in_range(*field, *number)) {
      throw_bad_value(*field, text);
    }
    **int_target = *number;
  } else {
    const std::optional<double> number = parse_number<double>(text);
    if (!number || !in_range(*field, *number)) {
      throw_bad_value(*field, text);
    }
    *std::get<double*>(field->value) = *number;
  }
}

void check_fields(const ConfigFields& fields) {
  for (const ConfigField& field : fields) {
    double const* const* number = std::get_if<double*>(&field.value);
    int const* const* count = std::get_if<int*>(&field.value);
    if ((number != nullptr && !in_range(field, **number)) || (count != nullptr && !in_range(field, **count))) {
      throw_bad_value(field, value_text(field));
    }
  }
}

std::string value_text(const ConfigField& field) {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, field.value);
}

std::string range_text(const ConfigField& field) {
  if (std::holds_alternative<bool*>(field.value)) {
    return "true or false";
  }
  const std::string unit = field.unit.empty() ? "" : " " + field.unit;
  const char* kind = std::holds_alternative<int*>(field.value) ? "a whole number from " : "";
  return fmt::format("{}{:g} to {:g}{}", kind, field.minimum, field.maximum, unit);
}

}  // namespace dynamic_icp
