// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "dynamic_icp/method/base/raw_scan.hpp"

// Numbers between NumPy and the library: what comes in is looked at where it lies, what goes out is moved.
namespace dynamic_icp::python {

namespace py = pybind11;

/// float32 or float64 numbers of shape (N,), any stride, in the memory of the array. Throws UsageError naming `name`,
/// what it is and what was expected.
Column column_of(const py::array& array, const char* name);

/// The three columns of an array of shape (N, 3).
VectorColumns vectors_of(const py::array& array, const char* name);

/// A rigid motion of an array of shape (4, 4).
Eigen::Isometry3d pose_of(const py::array& array, const char* name);

/// Rigid motions of an array of shape (K, 4, 4).
std::vector<Eigen::Isometry3d> poses_of(const py::array& array, const char* name);

/// A vector of an array of shape (size,).
Eigen::VectorXd vector_of(const py::array& array, Eigen::Index size, const char* name);

/// An array that owns the numbers and gives up their memory with itself.
template <class Number>
py::array_t<Number> moved(std::vector<Number> numbers) {
  auto* kept = new std::vector<Number>(std::move(numbers));
  const py::capsule owner(kept, [](void* all) { delete static_cast<std::vector<Number>*>(all); });
  return py::array_t<Number>(static_cast<py::ssize_t>(kept->size()), kept->data(), owner);
}

/// The same of points, of shape (N, 3).
py::array_t<double> moved(std::vector<Eigen::Vector3d> points);

/// A copy of a small matrix, or of a vector, whose shape is (N,).
template <class Derived>
py::array_t<double> copied(const Eigen::MatrixBase<Derived>& matrix) {
  if constexpr (Derived::ColsAtCompileTime == 1) {
    py::array_t<double> array(static_cast<py::ssize_t>(matrix.rows()));
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      array.mutable_at(i) = matrix(i);
    }
    return array;
  } else {
    py::array_t<double> array({static_cast<py::ssize_t>(matrix.rows()), static_cast<py::ssize_t>(matrix.cols())});
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
        array.mutable_at(i, j) = matrix(i, j);
      }
    }
    return array;
  }
}

inline py::array_t<double> copied(const Eigen::Isometry3d& pose) { return copied(pose.matrix()); }

/// Of shape (K, 4, 4).
py::array_t<double> copied(const std::vector<Eigen::Isometry3d>& poses);

/// None where there is nothing.
template <class Value>
py::object copied_or_none(const std::optional<Value>& value) {
  return value ? py::object(copied(*value)) : py::object(py::none());
}

/// None for an empty column, which stands for "not there".
template <class Value>
py::object moved_or_none(std::vector<Value> numbers) {
  return numbers.empty() ? py::object(py::none()) : py::object(moved(std::move(numbers)));
}

}  // namespace dynamic_icp::python
