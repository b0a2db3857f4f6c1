// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/eigen_layout.hpp"

void dynamic_icp::compile_for_the_vector_instructions_of_the_library::DYNAMIC_ICP_VECTORS() {}
