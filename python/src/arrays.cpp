// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "python/src/arrays.hpp"

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::python {
namespace {

std::string shape_of(const py::array& array) { return py::str(py::tuple(array.attr("shape"))).cast<std::string>(); }

/// Throws UsageError for another shape; -1 stands for any length.
void check_shape(const py::array& array, const std::vector<py::ssize_t>& expected, const char* name) {
  bool fits = array.ndim() == static_cast<py::ssize_t>(expected.size());
  std::string words;
  for (std::size_t axis = 0; axis < expected.size(); ++axis) {
    fits = fits && (expected[axis] < 0 || array.shape(static_cast<py::ssize_t>(axis)) == expected[axis]);
    words += (axis == 0 ? "" : ", ") + (expected[axis] < 0 ? std::string("N") : std::to_string(expected[axis]));
  }
  if (!fits) {
    throw UsageError(
        fmt::format("{} has shape {}, expected ({}{})", name, shape_of(array), words, expected.size() == 1 ? "," : ""));
  }
}

/// Whether the numbers are float32; throws UsageError where they are neither float32 nor float64.
bool is_float32(const py::array& array, const char* name) {
  const bool is_float = py::isinstance<py::array_t<float>>(array);
  if (!is_float && !py::isinstance<py::array_t<double>>(array)) {
    throw UsageError(fmt::format("{} is of type {}, expected float32 or float64; {}.astype(numpy.float64) makes it so",
                                 name, py::str(array.dtype()).cast<std::string>(), name));
  }
  return is_float;
}

/// What lies `offset` bytes after the first number, every `stride` bytes.
Column column_at(const py::array& array, bool is_float, py::ssize_t offset, py::ssize_t stride) {
  const auto size = static_cast<std::size_t>(array.shape(0));
  if (size == 0) {
    return {};
  }
  const char* const first = static_cast<const char*>(array.data()) + offset;
  return is_float ? Column(reinterpret_cast<const float*>(first), size, stride)
                  : Column(reinterpret_cast<const double*>(first), size, stride);
}

/// All numbers as double, C order; a copy where they are not that already.
py::array_t<double, py::array::c_style> doubles(const py::array& array, const char* name) {
  (void)is_float32(array, name);
  return py::array_t<double, py::array::c_style | py::array::forcecast>(array);
}

Eigen::Isometry3d pose_at(const double* rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      pose.matrix()(i, j) = rows[4 * i + j];
    }
  }
  return pose;
}

}  // namespace

Column column_of(const py::array& array, const char* name) {
  check_shape(array, {-1}, name);
  return column_at(array, is_float32(array, name), 0, array.strides(0));
}

VectorColumns vectors_of(const py::array& array, const char* name) {
  check_shape(array, {-1, 3}, name);
  const bool is_float = is_float32(array, name);
  const auto coordinate = [&](py::ssize_t axis) {
    return column_at(array, is_float, axis * array.strides(1), array.strides(0));
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

Eigen::Isometry3d pose_of(const py::array& array, const char* name) {
  check_shape(array, {4, 4}, name);
  return pose_at(doubles(array, name).data());
}

std::vector<Eigen::Isometry3d> poses_of(const py::array& array, const char* name) {
  check_shape(array, {-1, 4, 4}, name);
  const auto all = doubles(array, name);
  std::vector<Eigen::Isometry3d> poses;
  for (py::ssize_t k = 0; k < array.shape(0); ++k) {
    poses.push_back(pose_at(all.data() + 16 * k));
  }
  return poses;
}

Eigen::VectorXd vector_of(const py::array& array, Eigen::Index size, const char* name) {
  check_shape(array, {size}, name);
  const Column numbers = column_of(array, name);
  Eigen::VectorXd vector(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    vector[i] = numbers[static_cast<std::size_t>(i)];
  }
  return vector;
}

py::array_t<double> moved(std::vector<Eigen::Vector3d> points) {
  auto* kept = new std::vector<Eigen::Vector3d>(std::move(points));
  const py::capsule owner(kept, [](void* all) { delete static_cast<std::vector<Eigen::Vector3d>*>(all); });
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  const double* const first = kept->empty() ? nullptr : kept->front().data();
  return py::array_t<double>({static_cast<py::ssize_t>(kept->size()), py::ssize_t{3}}, first, owner);
}

py::array_t<double> copied(const std::vector<Eigen::Isometry3d>& poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{4}, py::ssize_t{4}});
  for (std::size_t k = 0; k < poses.size(); ++k) {
    for (Eigen::Index i = 0; i < 4; ++i) {
      for (Eigen::Index j = 0; j < 4; ++j) {
        array.mutable_at(static_cast<py::ssize_t>(k), i, j) = poses[k](i, j);
      }
    }
  }
  return array;
}

}  // namespace dynamic_icp::python
