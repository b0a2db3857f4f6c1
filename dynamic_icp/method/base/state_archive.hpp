// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "dynamic_icp/method/base/replace.hpp"
#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp {

/// What an object remembers, as bytes, and back again.
///
/// One function of a class, `void state(StateArchive& archive)`, names what it remembers, `archive(a_, b_)`: it serves
/// both directions, so that they cannot differ. Numbers keep all their bits. What is computed anew from the rest, or
/// for each scan, is left out. The bytes are those of this machine and of this version of the program; a checksum at
/// their end tells damaged ones. It is no signature: what a stranger wrote has one that fits, so that nothing that is
/// read may be believed. Numbers must be finite, rotations be rotations and enumerations have values with names; what
/// else must hold for the class to work (sizes that agree, indices in range, numbers in their limits) it asks for by
/// `require`.
///
/// An enumeration is read where a function `last_of(Enumeration)` beside it names the last of its values, of which the
/// first is 0.
class StateArchive {
 public:
  /// Writes.
  StateArchive() = default;

  /// Reads `bytes`, which must outlive it. Throws DataError when they are not as they were written.
  explicit StateArchive(std::string_view bytes);

  [[nodiscard]] bool reads() const { return reads_; }

  /// What was written, with its checksum.
  [[nodiscard]] std::string take();

  /// Appends their checksum to bytes.
  static void seal(std::string& bytes);

  /// Throws DataError unless all was read.
  void end() const;

  /// Throws DataError where what was read cannot have been written by this program: `holds` is false. `what` says what
  /// it is of ("the map"). What is written is not asked.
  void require(bool holds, std::string_view what) const;

  /// Writes these values, or reads them. Throws DataError when there are no bytes left.
  template <class... Values>
  void operator()(Values&... values) {
    (value(values), ...);
  }

  /// Numbers that may be anything, NaN among them.
  template <class Number>
  void any_numbers(std::vector<Number>& numbers) {
    numbers.resize(size_of(numbers.size(), sizeof(Number)));
    bytes(numbers.data(), numbers.size() * sizeof(Number));
  }

  /// Writes the elements of a vector, or reads them: as many copies of `blank` are made as there were, and
  /// `state_of(element)` reads each.
  template <class Element, class StateOf>
  void each(std::vector<Element>& elements, const std::type_identity_t<Element>& blank, const StateOf& state_of) {
    const std::size_t size = size_of(elements.size());
    if (reads_) {
      elements.clear();
    }
    for (std::size_t i = 0; i < size; ++i) {  // one by one: what is said to be there may not be, and would take memory
      if (i == elements.size()) {
        elements.push_back(blank);
      }
      state_of(elements[i]);
    }
  }
  template <class Element, class StateOf>
  void each(std::vector<Element>& elements, const StateOf& state_of) {
    each(elements, Element{}, state_of);
  }

 private:
  template <class Value>
  requires(std::is_arithmetic_v<Value>) void value(Value& number) {
    bytes(&number, sizeof number);
    check_numbers(&number, 1);
  }

  template <class Value>
  requires(std::is_enum_v<Value>) void value(Value& choice) {
    auto number = static_cast<std::underlying_type_t<Value>>(choice);
    bytes(&number, sizeof number);
    const auto wide = static_cast<std::int64_t>(number);
    require(wide >= 0 && wide <= static_cast<std::int64_t>(last_of(choice)), "a choice");
    choice = static_cast<Value>(number);
  }

  void value(bool& flag) {
    std::uint8_t byte = flag ? 1 : 0;
    bytes(&byte, 1);
    flag = byte != 0;
  }

  void value(Stamp& stamp) { value(stamp.ns); }

  void value(std::string& text) {
    text.resize(size_of(text.size()));
    bytes(text.data(), text.size());
  }

  template <class First, class Second>
  void value(std::pair<First, Second>& both) {
    value(both.first);
    value(both.second);
  }

  template <class Element>
  void value(std::optional<Element>& one) {
    bool is_there = one.has_value();
    value(is_there);
    if (!is_there) {
      one.reset();
      return;
    }
    if (!one) {
      one.emplace();
    }
    value(*one);
  }

  template <class Element, std::size_t size>
  void value(std::array<Element, size>& elements) {
    for (Element& element : elements) {
      value(element);
    }
  }

  template <class Element>
  void value(std::vector<Element>& elements) {
    if constexpr (std::is_arithmetic_v<Element>) {
      elements.resize(size_of(elements.size(), sizeof(Element)));
      bytes(elements.data(), elements.size() * sizeof(Element));
      check_numbers(elements.data(), elements.size());
    } else {
      const std::size_t size = size_of(elements.size());
      elements.resize(std::min(size, elements.size()));
      for (std::size_t i = 0; i < size; ++i) {
        if (i == elements.size()) {
          elements.emplace_back();
        }
        value(elements[i]);
      }
    }
  }

  template <class Key, class Element>
  void value(std::map<Key, Element>& elements) {
    const std::size_t size = size_of(elements.size());
    if (!reads_) {
      for (auto& [key, element] : elements) {
        Key copy = key;
        value(copy);
        value(element);
      }
      return;
    }
    elements.clear();
    for (std::size_t i = 0; i < size; ++i) {
      Key key{};
      value(key);
      value(elements[key]);
    }
  }

  template <class Number, int rows, int columns, int options, int max_rows, int max_columns>
  void value(Eigen::Matrix<Number, rows, columns, options, max_rows, max_columns>& matrix) {
    if constexpr (rows == Eigen::Dynamic || columns == Eigen::Dynamic) {
      const std::size_t height = size_of(static_cast<std::size_t>(matrix.rows()));
      const std::size_t width = size_of(static_cast<std::size_t>(matrix.cols()), height * sizeof(Number));
      const auto read_rows = static_cast<Eigen::Index>(height);
      const auto read_columns = static_cast<Eigen::Index>(width);
      if (read_rows != matrix.rows() || read_columns != matrix.cols()) {
        replace(matrix, std::decay_t<decltype(matrix)>::Zero(read_rows, read_columns));
      }
    }
    bytes(matrix.data(), static_cast<std::size_t>(matrix.size()) * sizeof(Number));
    check_numbers(matrix.data(), static_cast<std::size_t>(matrix.size()));
  }

  void value(Eigen::Isometry3d& T);

  template <class Object>
  requires(requires(Object& object, StateArchive& archive) { object.state(archive); }) void value(Object& object) {
    object.state(*this);
  }

  /// Writes a number of elements, or reads one: no larger than the bytes that are left, `each` of one.
  std::size_t size_of(std::size_t size, std::size_t each = 1);

  template <class Number>
  void check_numbers(const Number* numbers, std::size_t count) const {
    if constexpr (std::is_floating_point_v<Number>) {
      const auto is_possible = [](Number number) { return std::abs(number) <= Number{kLargestInState}; };
      require(!reads_ || std::all_of(numbers, numbers + count, is_possible), "a number");
    }
  }

  /// Beyond all that is measured or estimated; a few of them can be multiplied.
  static constexpr float kLargestInState = 1e30F;
  void bytes(void* data, std::size_t size);

  bool reads_ = false;
  std::string written_;
  std::string_view unread_;
};

}  // namespace dynamic_icp
