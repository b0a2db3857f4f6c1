// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp {

/// target = Target(value), for matrices and factorisations of Eigen whose size changes. Where there is no memory for
/// the new value, std::bad_alloc leaves `target` as it was. Eigen's own assignment frees the old numbers first and
/// keeps a pointer to them, which the destructor frees once more.
template <class Target, class Value>
void replace(Target& target, const Value& value) {
  target = Target(value);
}

}  // namespace dynamic_icp
