// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

// How Eigen aligns its vectors and matrices depends on the instruction set that a file is compiled for, and with it the
// layout of every struct that holds one. The library and all that includes its headers must agree.
static_assert(EIGEN_MAX_STATIC_ALIGN_BYTES == 16,
              "Dynamic-ICP: this file lays out Eigen's types otherwise than the library. Link the CMake target "
              "dynamic_icp::core, or compile with -DEIGEN_MAX_STATIC_ALIGN_BYTES=16");

// The linker keeps one of all functions of Eigen with the same name, and those of files with other vectors cut matrices
// up and free them otherwise. Where the library was compiled for others, this name stays undefined.
#if defined(__AVX512F__)
#define DYNAMIC_ICP_VECTORS avx512
#elif defined(__AVX__) && defined(__FMA__)
#define DYNAMIC_ICP_VECTORS avx_fma
#elif defined(__AVX__)
#define DYNAMIC_ICP_VECTORS avx
#else
#define DYNAMIC_ICP_VECTORS baseline
#endif

namespace dynamic_icp::compile_for_the_vector_instructions_of_the_library {

void DYNAMIC_ICP_VECTORS();
[[gnu::used]] inline void (*const kAsked)() = &DYNAMIC_ICP_VECTORS;

}  // namespace dynamic_icp::compile_for_the_vector_instructions_of_the_library
