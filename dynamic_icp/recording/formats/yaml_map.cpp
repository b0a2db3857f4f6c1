// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/yaml_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/method/base/nearest_key.hpp"
#include "dynamic_icp/method/base/parse_number.hpp"
#include "dynamic_icp/recording/formats/whole_file.hpp"
#include "dynamic_icp/recording/formats/yaml_node.hpp"

namespace dynamic_icp::formats {
namespace {

std::string range_words(Limits limits) {
  if (std::isinf(limits.maximum)) {
    return std::isinf(limits.minimum) ? "a finite number" : fmt::format("at least {:g}", limits.minimum);
  }
  return fmt::format("{:g} to {:g}", limits.minimum, limits.maximum);
}

std::string list_words(std::size_t count, Limits limits) {
  const std::string numbers = count == 0 ? "numbers" : fmt::format("{} numbers", count);
  return fmt::format("a list of {}, each {}", numbers, range_words(limits));
}

std::string joined(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

template <class Number>
std::optional<Number> number_within(const YAML::Node& node, Limits limits) {
  const std::optional<Number> number = node.IsScalar() ? parse_number<Number>(node.Scalar()) : std::nullopt;
  const bool allowed = number && std::isfinite(static_cast<double>(*number)) &&
                       static_cast<double>(*number) >= limits.minimum && static_cast<double>(*number) <= limits.maximum;
  return allowed ? number : std::nullopt;
}

/// A text that is not empty.
std::optional<std::string> text_of(const YAML::Node& node) {
  return node.IsScalar() && !node.Scalar().empty() ? std::optional(node.Scalar()) : std::nullopt;
}

}  // namespace

struct YamlMap::Entry {
  std::string key;
  YAML::Node key_node;
  YAML::Node value;
};

struct YamlMap::Contents {
  std::filesystem::path origin;
  std::string path;  ///< the keys above, e.g. "vehicle"; empty at the top
  int line = 1;
  std::vector<Entry> entries;
  std::set<std::string, std::less<>> asked;
  /// Maps of this map that were asked for, by the place of their key in the text and their path.
  std::map<std::pair<int, std::string>, std::shared_ptr<Contents>> taken;

  [[nodiscard]] std::string path_of(std::string_view key) const {
    return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
  }

  [[noreturn]] void fail(int at_line, std::string_view message) const {
    throw UsageError(fmt::format("{}: {}", place(origin, at_line), message));
  }

  /// The error about a value that is not what it should be.
  [[noreturn]] void refuse(const Entry& entry, const YAML::Node& value, std::string_view expected) const {
    const int at_line = value.IsDefined() && !value.IsNull() ? line_of(value) : line_of(entry.key_node);
    fail(at_line, fmt::format("'{}' is {}, expected {}", path_of(entry.key), found(value), expected));
  }

  /// A list of exactly `count` numbers (0: any but none), called `name` in messages.
  [[nodiscard]] std::vector<double> row(const Entry& entry, const YAML::Node& list, const std::string& name,
                                        std::size_t count, Limits limits) const {
    const bool absent = !list.IsDefined() || list.IsNull();
    if (!list.IsSequence() || list.size() == 0 || (count != 0 && list.size() != count)) {
      fail(line_of(absent ? entry.key_node : list),
           fmt::format("{} is {}, expected {}", name, found(list), list_words(count, limits)));
    }
    std::vector<double> numbers;
    for (const YAML::Node& node : list) {
      const std::optional<double> number = number_within<double>(node, limits);
      if (!number) {
        fail(line_of(node), fmt::format("number {} of {} is {}, expected {}", numbers.size() + 1, name, found(node),
                                        range_words(limits)));
      }
      numbers.push_back(*number);
    }
    return numbers;
  }

  void fill(const YAML::Node& node) {
    std::set<std::string> keys;
    for (const auto& entry : node) {
      const int at_line = line_of(entry.first);
      if (!entry.first.IsScalar() || entry.first.Scalar().empty()) {
        fail(at_line, fmt::format("a key is {}, expected a name", found(entry.first)));
      }
      const std::string key = entry.first.Scalar();
      if (!keys.insert(key).second) {
        fail(at_line, fmt::format("'{}' is set twice", path_of(key)));
      }
      entries.push_back({key, entry.first, entry.second});
    }
  }

  void finish() const {
    const std::vector<std::string> known(asked.begin(), asked.end());
    for (const Entry& entry : entries) {
      if (asked.find(entry.key) == asked.end()) {
        const std::string hint =
            known.empty() ? "" : fmt::format("; did you mean '{}'?", nearest_key(entry.key, known));
        fail(line_of(entry.key_node), fmt::format("unknown key '{}'{}", path_of(entry.key), hint));
      }
    }
    for (const auto& [key, map] : taken) {
      map->finish();
    }
  }
};

YamlMap YamlMap::parse(std::string_view text, const std::filesystem::path& origin, Blank blank) {
  const YAML::Node root = parse_document(text, origin);
  auto contents = std::make_shared<Contents>();
  contents->origin = origin;
  if (!root.IsDefined() && blank == Blank::kRefused) {
    contents->fail(1, "holds nothing, expected a map of keys");
  }
  if (root.IsDefined()) {
    contents->line = line_of(root);
    if (!root.IsMap()) {
      contents->fail(contents->line, fmt::format("holds {}, expected a map of keys", found(root)));
    }
    contents->fill(root);
  }
  return YamlMap(contents);
}

YamlMap YamlMap::load(const std::filesystem::path& path, Blank blank) {
  return parse(read_text_file(path), path, blank);
}

const YamlMap::Entry* YamlMap::find(std::string_view key) const {
  contents_->asked.emplace(key);
  const auto entry = std::find_if(contents_->entries.begin(), contents_->entries.end(),
                                  [&](const Entry& candidate) { return candidate.key == key; });
  return entry == contents_->entries.end() ? nullptr : &*entry;
}

const YamlMap::Entry& YamlMap::at(std::string_view key, std::string_view expected) const {
  const Entry* entry = find(key);
  if (entry == nullptr) {
    const std::string owner = contents_->path.empty() ? "" : fmt::format(" in '{}'", contents_->path);
    contents_->fail(contents_->line, fmt::format("the key '{}' is missing{}, expected {}", key, owner, expected));
  }
  return *entry;
}

YamlMap YamlMap::child(const Entry& entry, const std::string& path) const {
  std::shared_ptr<Contents>& contents = contents_->taken[{entry.key_node.Mark().pos, path}];
  if (contents == nullptr) {
    contents = std::make_shared<Contents>();
    contents->origin = contents_->origin;
    contents->path = path;
    contents->line = line_of(entry.key_node);
    contents->fill(entry.value);
  }
  return YamlMap(contents);
}

bool YamlMap::has(std::string_view key) const { return find(key) != nullptr; }

/// What `read` makes of the value, or the fallback where there is one and not the key.
template <class Value, class Read>
Value YamlMap::value(std::string_view key, std::optional<Value> fallback, const std::string& expected,
                     const Read& read) const {
  if (fallback && !has(key)) {
    return *fallback;
  }
  const Entry& entry = at(key, expected);
  const std::optional<Value> read_value = read(entry.value);
  if (!read_value) {
    contents_->refuse(entry, entry.value, expected);
  }
  return *read_value;
}

std::string YamlMap::text(std::string_view key, std::optional<std::string> fallback) const {
  return value(key, std::move(fallback), "a text", text_of);
}

std::string YamlMap::choice(std::string_view key, const std::vector<std::string>& allowed,
                            std::optional<std::string> fallback) const {
  return value(key, std::move(fallback), fmt::format("one of: {}", joined(allowed)), [&](const YAML::Node& node) {
    const std::optional<std::string> text = text_of(node);
    return text && std::find(allowed.begin(), allowed.end(), *text) != allowed.end() ? text : std::nullopt;
  });
}

double YamlMap::number(std::string_view key, Limits limits, std::optional<double> fallback) const {
  return value(key, fallback, range_words(limits),
               [&](const YAML::Node& node) { return number_within<double>(node, limits); });
}

int YamlMap::whole_number(std::string_view key, Limits limits, std::optional<int> fallback) const {
  return value(key, fallback, "a whole number from " + range_words(limits),
               [&](const YAML::Node& node) { return number_within<int>(node, limits); });
}

bool YamlMap::flag(std::string_view key, bool fallback) const {
  return choice(key, {"true", "false"}, fallback ? "true" : "false") == "true";
}

std::vector<double> YamlMap::numbers(std::string_view key, std::size_t count, Limits limits) const {
  const Entry& entry = at(key, list_words(count, limits));
  return contents_->row(entry, entry.value, fmt::format("'{}'", contents_->path_of(key)), count, limits);
}

std::vector<double> YamlMap::numbers_or_none(std::string_view key, Limits limits) const {
  const Entry& entry = at(key, list_words(0, limits));
  const bool is_none = entry.value.IsSequence() && entry.value.size() == 0;
  return is_none ? std::vector<double>() : numbers(key, 0, limits);
}

std::vector<std::string> YamlMap::texts(std::string_view key) const {
  const std::string expected = "a list of texts";
  const Entry& entry = at(key, expected);
  if (!entry.value.IsSequence() || entry.value.size() == 0) {
    contents_->refuse(entry, entry.value, expected);
  }
  std::vector<std::string> texts;
  for (const YAML::Node& node : entry.value) {
    const std::optional<std::string> text = text_of(node);
    if (!text) {
      contents_->refuse(entry, node, expected);
    }
    texts.push_back(*text);
  }
  return texts;
}

std::vector<std::vector<double>> YamlMap::rows(std::string_view key, std::size_t columns, Limits limits) const {
  const std::string expected =
      columns == 0 ? "a list of equally long lists of numbers" : fmt::format("a list of lists of {} numbers", columns);
  const Entry& entry = at(key, expected);
  if (!entry.value.IsSequence() || entry.value.size() == 0) {
    contents_->refuse(entry, entry.value, expected);
  }
  std::vector<std::vector<double>> rows;
  for (const YAML::Node& node : entry.value) {
    const std::string name = fmt::format("row {} of '{}'", rows.size() + 1, contents_->path_of(key));
    rows.push_back(contents_->row(entry, node, name, rows.empty() ? columns : rows.front().size(), limits));
  }
  return rows;
}

YamlMap YamlMap::map(std::string_view key) const {
  const Entry& entry = at(key, "a map");
  if (!entry.value.IsMap()) {
    contents_->refuse(entry, entry.value, "a map");
  }
  return child(entry, contents_->path_of(key));
}

std::vector<YamlMap> YamlMap::list(std::string_view key) const {
  constexpr std::string_view kExpected = "a list of maps";
  const Entry* entry = find(key);
  std::vector<YamlMap> maps;
  if (entry == nullptr) {
    return maps;
  }
  if (!entry->value.IsSequence()) {
    contents_->refuse(*entry, entry->value, kExpected);
  }
  for (const YAML::Node& node : entry->value) {
    if (!node.IsMap()) {
      contents_->refuse(*entry, node, kExpected);
    }
    maps.push_back(child({entry->key, node, node}, contents_->path_of(key)));
  }
  return maps;
}

std::vector<std::pair<std::string, YamlMap>> YamlMap::kinds(std::string_view key) const {
  std::vector<std::pair<std::string, YamlMap>> kinds;
  for (const YamlMap& item : list(key)) {
    const std::vector<Entry>& entries = item.contents_->entries;
    if (entries.size() != 1) {
      item.fail(fmt::format("an item of '{}' has {} keys, expected one, the kind: '- kind: {{...}}'",
                            contents_->path_of(key), entries.size()));
    }
    const Entry& only = entries.front();
    item.contents_->asked.insert(only.key);
    const std::string path = item.contents_->path_of(only.key);
    if (!only.value.IsMap() && !only.value.IsNull()) {
      item.contents_->refuse(only, only.value, "a map");
    }
    kinds.emplace_back(only.key, item.child(only, path));
  }
  return kinds;
}

std::vector<std::pair<std::string, YamlMap>> YamlMap::entries(std::string_view key) const {
  std::vector<std::pair<std::string, YamlMap>> entries;
  if (!has(key)) {
    return entries;
  }
  const YamlMap parent = map(key);
  for (const Entry& entry : parent.contents_->entries) {
    entries.emplace_back(entry.key, parent.map(entry.key));
  }
  return entries;
}

void YamlMap::settings(std::string_view key, const ConfigFields& fields) const {
  if (has(key)) {
    map(key).settings(fields);
  }
}

void YamlMap::settings(const ConfigFields& fields) const {
  SettingsReader reader(contents_->origin, fields);
  for (const Entry& entry : contents_->entries) {
    contents_->asked.insert(entry.key);
    reader.read(entry.key_node, entry.value, entry.key);
  }
}

void YamlMap::finish() const { contents_->finish(); }

void YamlMap::fail(std::string_view key, std::string_view message) const {
  const Entry* entry = find(key);
  const int at_line = entry == nullptr ? contents_->line : line_of(entry->key_node);
  contents_->fail(at_line, fmt::format("'{}' {}", contents_->path_of(key), message));
}

void YamlMap::fail(std::string_view message) const { contents_->fail(contents_->line, message); }

const std::filesystem::path& YamlMap::origin() const { return contents_->origin; }

}  // namespace dynamic_icp::formats
