// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include "dynamic_icp/method/base/parallel.hpp"

namespace dynamic_icp {

inline const Workers kOneThread(1);

}  // namespace dynamic_icp
