// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace dynamic_icp::report {

using Json = nlohmann::ordered_json;

/// The number with so many decimals, null when it is not finite. Fewer digits keep the page small.
Json rounded(double value, int decimals);

/// The same with so many significant digits.
Json significant(double value, int digits);

/// The value as it may stand inside of an HTML element: `<`, `>` and `&`, which in JSON only occur in texts, as
/// escapes. Bytes that are no UTF-8 become U+FFFD.
std::string embeddable(const Json& value);

}  // namespace dynamic_icp::report
