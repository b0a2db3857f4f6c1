// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dynamic_icp/method/base/config_field.hpp"

namespace dynamic_icp::formats {

/// The smallest and the largest allowed number.
struct Limits {
  double minimum = 0.0;
  double maximum = 0.0;
};

/// A map of a YAML document that is read key by key; what nobody asked for is an error in the end (`finish`).
///
/// Every error begins with "<file>: line <n>: " and names the key with the keys above it ("vehicle.start_m"), what was
/// found and what is allowed. It is a UsageError; a DataError where the text is no YAML or the file cannot be read.
/// Numbers are finite. Copies share what was asked for. Not for use by several threads at once.
class YamlMap {
 public:
  enum class Blank { kRefused, kEmptyMap };  ///< what becomes of a document with nothing in it

  /// The map at the top of a text; `origin` is the file that messages name. No key may stand twice in a map.
  static YamlMap parse(std::string_view text, const std::filesystem::path& origin, Blank blank = Blank::kRefused);
  static YamlMap load(const std::filesystem::path& path, Blank blank = Blank::kRefused);

  /// Whether the key is there. Counts as asking for it.
  [[nodiscard]] bool has(std::string_view key) const;

  // One value. Without `fallback` the key must be there.

  /// Not empty.
  [[nodiscard]] std::string text(std::string_view key, std::optional<std::string> fallback = {}) const;
  [[nodiscard]] std::string choice(std::string_view key, const std::vector<std::string>& allowed,
                                   std::optional<std::string> fallback = {}) const;
  [[nodiscard]] double number(std::string_view key, Limits limits, std::optional<double> fallback = {}) const;
  [[nodiscard]] int whole_number(std::string_view key, Limits limits, std::optional<int> fallback = {}) const;
  [[nodiscard]] bool flag(std::string_view key, bool fallback) const;  ///< true or false

  // Lists of numbers.

  /// A list of exactly `count` numbers; with `count` 0 a list of any length but zero.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count, Limits limits) const;
  /// A list of any length, also of none.
  [[nodiscard]] std::vector<double> numbers_or_none(std::string_view key, Limits limits) const;
  /// A list of at least one list of `columns` numbers each; with `columns` 0 each is as long as the first.
  [[nodiscard]] std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns, Limits limits) const;

  /// A list of at least one text, none of them empty.
  [[nodiscard]] std::vector<std::string> texts(std::string_view key) const;

  // Maps in this map, in the order of the file.

  [[nodiscard]] YamlMap map(std::string_view key) const;                ///< the key must be there
  [[nodiscard]] std::vector<YamlMap> list(std::string_view key) const;  ///< a list of maps; empty without the key

  /// A list of maps with one key each, as ("box", map) for "- box: {size_m: ...}"; empty without the key. After "box:"
  /// there may be nothing: an empty map.
  [[nodiscard]] std::vector<std::pair<std::string, YamlMap>> kinds(std::string_view key) const;

  /// A map of named maps; empty without the key.
  [[nodiscard]] std::vector<std::pair<std::string, YamlMap>> entries(std::string_view key) const;

  /// A map of settings by their keys, nested or dotted (config_field.hpp); nothing happens without the key.
  void settings(std::string_view key, const ConfigFields& fields) const;

  /// All of this map as settings.
  void settings(const ConfigFields& fields) const;

  /// Throws for the first key of this map, or of a map that was taken from it, that nobody asked for: names the nearest
  /// known key.
  void finish() const;

  /// Throws an error at the line of that key (of this map where the key is missing): "<file>: line <n>: '<key>'
  /// <message>".
  [[noreturn]] void fail(std::string_view key, std::string_view message) const;

  /// Throws an error at the line of this map: "<file>: line <n>: <message>".
  [[noreturn]] void fail(std::string_view message) const;

  [[nodiscard]] const std::filesystem::path& origin() const;

 private:
  struct Contents;
  struct Entry;

  explicit YamlMap(std::shared_ptr<Contents> contents) : contents_(std::move(contents)) {}

  [[nodiscard]] const Entry* find(std::string_view key) const;
  [[nodiscard]] const Entry& at(std::string_view key, std::string_view expected) const;
  template <class Value, class Read>
  Value value(std::string_view key, std::optional<Value> fallback, const std::string& expected, const Read& read) const;
  [[nodiscard]] YamlMap child(const Entry& entry, const std::string& path) const;

  std::shared_ptr<Contents> contents_;
};

}  // namespace dynamic_icp::formats
