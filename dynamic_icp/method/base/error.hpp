// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace dynamic_icp {

/// Input data, a file or the machine is not as it must be. The message names the file, the place in it and what was
/// expected. The program ends with status 1.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller asked for something that cannot be: an unknown key, a value out of range, options that exclude each
/// other. The message names the key and the valid range. The program ends with status 2.
class UsageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

}  // namespace dynamic_icp
