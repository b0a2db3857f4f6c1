// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace dynamic_icp::formats {

/// A JSON object with its place in a file. Every getter throws a DataError that names the place and the key when the
/// value is missing or of another kind. The object must outlive it.
class JsonRow {
 public:
  using Json = nlohmann::ordered_json;

  JsonRow(const Json& object, std::string place);

  [[nodiscard]] bool has(const char* key) const { return object_.contains(key); }
  [[nodiscard]] const Json& get(const char* key) const;
  [[nodiscard]] const Json& list(const char* key) const { return get(key, &Json::is_array, "a list"); }
  [[nodiscard]] std::int64_t integer(const char* key) const {
    return get(key, &Json::is_number_integer, "a whole number").get<std::int64_t>();
  }
  [[nodiscard]] bool truth(const char* key) const { return get(key, &Json::is_boolean, "true or false").get<bool>(); }
  [[nodiscard]] std::string text(const char* key) const {
    return get(key, &Json::is_string, "a text").get<std::string>();
  }

  /// NaN where the value is null.
  [[nodiscard]] double number(const char* key) const { return number(get(key), key); }
  [[nodiscard]] double number(const Json& value, const char* key) const;
  [[nodiscard]] Eigen::Vector3d vector(const char* key) const;
  /// Three numbers, none of them null.
  [[nodiscard]] Eigen::Vector3d finite_vector(const char* key) const;

  template <int kSize>
  [[nodiscard]] Eigen::Matrix<double, kSize, 1> numbers(const char* key) const {
    check_size(key, kSize);
    Eigen::Matrix<double, kSize, 1> numbers;
    for (int k = 0; k < kSize; ++k) {
      numbers[k] = number(get(key)[static_cast<std::size_t>(k)], key);
    }
    return numbers;
  }

  [[nodiscard]] JsonRow object(const char* key) const { return part(key, get(key)); }

  /// A part of the value of a key, which must be an object.
  [[nodiscard]] JsonRow part(const char* key, const Json& value) const;

  [[noreturn]] void fail(const char* key, std::string_view expected) const;

 private:
  [[nodiscard]] const Json& get(const char* key, bool (Json::*is_kind)() const noexcept,
                                std::string_view expected) const;
  void check_size(const char* key, std::size_t size) const;

  const Json& object_;
  std::string place_;
};

/// The JSON object that makes up a file. Throws DataError naming the file.
nlohmann::ordered_json read_json_object(const std::filesystem::path& path);

/// Calls use(object) for each line of a file of JSON objects that is not empty. Throws DataError naming file and line.
void for_each_json_line(const std::filesystem::path& path, const std::function<void(const JsonRow&)>& use);

}  // namespace dynamic_icp::formats
