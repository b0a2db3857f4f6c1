// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::formats {

/// Calls `read`. Where the machine has too little memory for what the file holds, throws DataError that names the file:
/// without a name nobody knows which of a thousand scans it was.
template <class Read>
auto with_memory_for(const std::filesystem::path& path, const Read& read) {
  const auto error = [&] {
    return DataError(fmt::format("{}: the machine has too little memory left for what it holds", path.string()));
  };
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw error();
  } catch (const std::length_error&) {  // more than a container can ever hold
    throw error();
  }
}

}  // namespace dynamic_icp::formats
