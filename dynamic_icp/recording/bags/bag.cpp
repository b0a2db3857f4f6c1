// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/bag.hpp"

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp::bags {

std::filesystem::path find_bag(const std::filesystem::path& /*input*/, std::string_view /*container*/) { return {}; }

std::unique_ptr<Bag> open_bag(const std::filesystem::path& found) { throw DataError(found.string()); }

}  // namespace dynamic_icp::bags
