// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace dynamic_icp::report {

/// The bytes as a zlib stream (RFC 1950). The same bytes give the same stream with the same library.
std::string zlib_stream(std::string_view bytes);

}  // namespace dynamic_icp::report
