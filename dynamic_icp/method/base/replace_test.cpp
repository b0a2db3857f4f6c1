// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/replace.hpp"

#include <new>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <gtest/gtest.h>

/// The address sanitizer ends the process where there is no memory, unless it is asked not to.
extern "C" const char* __asan_default_options() { return "allocator_may_return_null=1"; }  // NOLINT

namespace dynamic_icp {
namespace {

// 128 TiB: no process has as much.
constexpr Eigen::Index kTooMany = Eigen::Index{1} << 22;

TEST(Replace, WithoutMemoryAMatrixStaysAsItWas) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Constant(3, 3, 2.0);
  EXPECT_THROW(replace(matrix, Eigen::MatrixXd::Zero(kTooMany, kTooMany)), std::bad_alloc);
  EXPECT_EQ(matrix, Eigen::MatrixXd::Constant(3, 3, 2.0));
}

TEST(Replace, WithoutMemoryAFactorisationStaysAsItWas) {
  Eigen::LLT<Eigen::MatrixXd> factor(4.0 * Eigen::MatrixXd::Identity(3, 3));
  EXPECT_THROW(replace(factor, Eigen::MatrixXd::Identity(kTooMany, kTooMany)), std::bad_alloc);
  EXPECT_EQ(factor.matrixLLT().diagonal(), Eigen::Vector3d::Constant(2.0));
}

TEST(Replace, TakesTheSizeOfTheValue) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3, 3);
  replace(matrix, Eigen::MatrixXd::Ones(2, 5));
  EXPECT_EQ(matrix, Eigen::MatrixXd::Ones(2, 5));
}

}  // namespace
}  // namespace dynamic_icp
