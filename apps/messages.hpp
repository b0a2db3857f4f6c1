// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string_view>

#include <fmt/format.h>

namespace dynamic_icp::apps {

/// Prints text to standard error, wrapped for its terminal but for what redraws its line. What cannot be printed there
/// can be told nowhere: it never throws and ends no work.
void tell_text(std::string_view text) noexcept;

/// The same of a formatted text.
template <class... Values>
void tell(fmt::format_string<Values...> format, Values&&... values) noexcept {
  try {
    tell_text(fmt::format(format, std::forward<Values>(values)...));
  } catch (const std::exception&) {  // no memory for the text
    std::fputs("dynamic-icp: a message is lost: no memory\n", stderr);
  }
}

}  // namespace dynamic_icp::apps
