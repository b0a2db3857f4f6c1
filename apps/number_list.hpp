// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace dynamic_icp::apps {

/// The numbers of a list as users write it, "10,20-25": ascending, each once; none for an empty text. Throws UsageError
/// naming the option when a part is no number or range.
std::vector<std::size_t> number_list(const char* option, const std::string& text);

}  // namespace dynamic_icp::apps
