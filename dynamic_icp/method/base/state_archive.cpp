// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/method/base/state_archive.hpp"

#include <algorithm>
#include <cstring>

#include <Eigen/LU>

#include "dynamic_icp/method/base/error.hpp"

namespace dynamic_icp {
namespace {

constexpr double kOrthogonality = 1e-3;  // rounding errors are far smaller

bool is_rigid(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < kOrthogonality &&
         R.determinant() > 0.0 && T.matrix().row(3) == Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0);
}

/// FNV-1a over words of eight bytes, the last one filled up with zeros. A step is invertible in each word: bytes that
/// differ within one word never have the same sum.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t sum = 0xcbf29ce484222325U ^ bytes.size();
  for (std::size_t at = 0; at < bytes.size(); at += sizeof sum) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min(sizeof word, bytes.size() - at));
    sum = (sum ^ word) * 0x100000001b3U;
    sum ^= sum >> 32;
  }
  return sum;
}

}  // namespace

StateArchive::StateArchive(std::string_view bytes) : reads_(true) {
  std::uint64_t sum = 0;
  if (bytes.size() < sizeof sum) {
    throw DataError("a saved state is cut off");
  }
  unread_ = bytes.substr(0, bytes.size() - sizeof sum);
  std::memcpy(&sum, bytes.data() + unread_.size(), sizeof sum);
  if (sum != checksum(unread_)) {
    throw DataError("a saved state is damaged: its checksum does not fit");
  }
}

std::string StateArchive::take() {
  seal(written_);
  return std::exchange(written_, {});
}

void StateArchive::seal(std::string& bytes) {
  const std::uint64_t sum = checksum(bytes);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
}

void StateArchive::end() const {
  if (!unread_.empty()) {
    throw DataError("a saved state holds more than this program reads");
  }
}

void StateArchive::require(bool holds, std::string_view what) const {
  if (reads_ && !holds) {
    throw DataError("a saved state is none that this program writes: " + std::string(what) + " of it cannot be");
  }
}

void StateArchive::value(Eigen::Isometry3d& T) {
  value(T.matrix());
  require(is_rigid(T), "a pose");
}

std::size_t StateArchive::size_of(std::size_t size, std::size_t each) {
  auto number = static_cast<std::uint64_t>(size);
  value(number);
  if (reads_ && number > unread_.size() / std::max<std::size_t>(1, each)) {
    throw DataError("a saved state says that it holds more than it does");
  }
  return static_cast<std::size_t>(number);
}

void StateArchive::bytes(void* data, std::size_t size) {
  if (size == 0) {
    return;  // nor need there be any data
  }
  if (!reads_) {
    written_.append(static_cast<const char*>(data), size);
    return;
  }
  if (size > unread_.size()) {
    throw DataError("a saved state holds less than this program reads");
  }
  std::memcpy(data, unread_.data(), size);
  unread_.remove_prefix(size);
}

}  // namespace dynamic_icp
