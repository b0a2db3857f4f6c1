// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <random>

#include <Eigen/Core>
#include <Eigen/Geometry>

// Matrix decompositions for tests, of one type and compiled once: each takes a compiler 4 to 70 seconds. They share
// nothing with those of the method.
namespace dynamic_icp::dense {

/// x that minimises |A x - b|, by QR with column pivoting.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// In descending order.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

/// In columns, that of the largest singular value first.
Eigen::MatrixXd left_singular_vectors(const Eigen::MatrixXd& A);

/// X of A X = B, for any A that has an inverse.
Eigen::MatrixXd solve(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Of any A that has one.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);

/// L of L L^T = A. The factor of a matrix that is not definite is not a number.
Eigen::MatrixXd cholesky_root(const Eigen::MatrixXd& A);

/// Eigenvalues of a symmetric matrix in ascending order, and its eigenvectors in columns.
struct SymmetricParts {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricParts symmetric_parts(const Eigen::MatrixXd& A);

/// The rigid motion that takes the columns of `from` nearest to those of `to`, by Umeyama's closed form.
Eigen::Isometry3d rigid_motion(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// Of normal numbers.
Eigen::MatrixXd random_matrix(std::mt19937& random, Eigen::Index rows, Eigen::Index columns);

/// Symmetric, with eigenvalues of one and more.
Eigen::MatrixXd random_information(std::mt19937& random, Eigen::Index n);

/// e^T covariance^-1 e: the normalised estimation error squared.
double normalised_squared(const Eigen::VectorXd& e, const Eigen::MatrixXd& covariance);

}  // namespace dynamic_icp::dense
