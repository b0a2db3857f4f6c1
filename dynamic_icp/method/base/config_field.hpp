// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dynamic_icp {

/// One setting of a configuration struct: where it lives, what it may be and what it means.
///
/// Every configuration struct has one function `ConfigFields fields(TheConfig&)` beside it. That list is the only
/// place where a setting is described; the YAML file, `--set key=value`, the checks, `run.json` and
/// `docs/configuration.md` are all made from it. Defaults are the initialisers in the struct and stand nowhere else.
struct ConfigField {
  using Value = std::variant<double*, int*, bool*>;

  std::string key;  ///< dotted path, e.g. "preprocess.voxel_size_m"
  Value value;
  double minimum = 0.0;  ///< smallest allowed value; without meaning for switches
  double maximum = 0.0;  ///< largest allowed value; without meaning for switches
  std::string unit;      ///< as written in the documentation; empty for numbers without unit
  std::string description;
};

using ConfigFields = std::vector<ConfigField>;

/// The same fields with "prefix." before each key, appended to `into`.
void append_fields(ConfigFields& into, std::string_view prefix, ConfigFields fields);

/// Sets the field called `key` from text ("0.3", "100", "true"). Throws UsageError naming the key and the valid range
/// when the key is unknown (with the nearest known key as a suggestion), the text is no such value, or it is out of
/// range; the configuration is unchanged then.
void set_field(const ConfigFields& fields, std::string_view key, std::string_view text);

/// Throws UsageError naming the first field whose value is out of its range or not finite: for configurations that
/// were filled in by code.
void check_fields(const ConfigFields& fields);

/// The value of a field as text that `set_field` reads back to the same value.
std::string value_text(const ConfigField& field);

/// The allowed values in words, e.g. "0.01 to 100 m", "1 to 1000", "true or false".
std::string range_text(const ConfigField& field);

}  // namespace dynamic_icp
