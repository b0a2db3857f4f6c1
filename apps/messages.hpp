// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>
#include <string>

#include <fmt/format.h>

namespace dynamic_icp::apps {

/// Prints to standard error. What cannot be printed there can be told nowhere: it never throws and ends no work.
template <class... Values>
void tell(fmt::format_string<Values...> format, Values&&... values) noexcept {
  try {
    const std::string text = fmt::format(format, std::forward<Values>(values)...);
    (void)std::fwrite(text.data(), 1, text.size(), stderr);
  } catch (const std::exception&) {  // no memory for the text
    std::fputs("dynamic-icp: a message is lost: no memory\n", stderr);
  }
}

}  // namespace dynamic_icp::apps
