// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

// How Eigen aligns its vectors and matrices depends on the instruction set that a file is compiled for, and with it the
// layout of every struct that holds one. The library and all that includes its headers must agree.
static_assert(EIGEN_MAX_STATIC_ALIGN_BYTES == 16,
              "Dynamic-ICP: this file lays out Eigen's types otherwise than the library. Link the CMake target "
              "dynamic_icp::core, or compile with -DEIGEN_MAX_STATIC_ALIGN_BYTES=16");
