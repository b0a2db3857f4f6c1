// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/base/config_field.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "dynamic_icp/base/error.hpp"

namespace dynamic_icp {
namespace {

/// Levenshtein distance, to suggest the key that was meant.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) {
    row[j] = j;
  }
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] == b[j - 1] ? 0 : 1)});
      diagonal = above;
    }
  }
  return row[b.size()];
}

/// How far `typed` is from `key`; the last part alone ("voxel_size_m") counts as the whole key.
std::size_t key_distance(std::string_view typed, std::string_view key) {
  const std::size_t dot = key.rfind('.');
  const std::string_view last = dot == std::string_view::npos ? key : key.substr(dot + 1);
  return std::min(edit_distance(typed, key), edit_distance(typed, last));
}

[[noreturn]] void throw_unknown_key(const ConfigFields& fields, std::string_view key) {
  const auto nearest = std::min_element(fields.begin(), fields.end(), [&](const ConfigField& a, const ConfigField& b) {
    return key_distance(key, a.key) < key_distance(key, b.key);
  });
  if (nearest == fields.end()) {
    throw UsageError(fmt::format("unknown configuration key '{}'", key));
  }
  throw UsageError(
      fmt::format("unknown configuration key '{}'; did you mean '{}' ({})?", key, nearest->key, range_text(*nearest)));
}

[[noreturn]] void throw_bad_value(const ConfigField& field, std::string_view text) {
  throw UsageError(fmt::format("configuration key '{}' is '{}', expected {}", field.key, text, range_text(field)));
}

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.size() > 1 && text.front() == '+') {
    text.remove_prefix(1);
  }
  Number number{};
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return number;
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
