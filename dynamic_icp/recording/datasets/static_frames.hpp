// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::datasets {

/// Frames that are fixed to each other, as a tree by their names.
class StaticFrames {
 public:
  /// A later transform of the same child replaces the earlier one.
  void add(const messages::StampedTransform& transform);

  /// Whether a frame is fixed to another one above it.
  [[nodiscard]] bool has_parent(const std::string& frame) const { return parents_.contains(frame); }

  /// "map", "odom" and the like: what hangs on them moves.
  static bool is_world(const std::string& frame);

  [[nodiscard]] bool empty() const { return parents_.empty(); }

  /// T_a_b, nothing where no chain of transforms leads from one to the other. Any frame is itself.
  [[nodiscard]] std::optional<Eigen::Isometry3d> transform(const std::string& a, const std::string& b) const;

  /// The frame of the vehicle that a frame hangs on: base_link, base_footprint, vehicle, ... (the first of such names
  /// among those above it, whatever a namespace before a slash), else the uppermost one that is not of the world (map,
  /// odom, ...); empty where nothing is above it.
  [[nodiscard]] std::string base_of(const std::string& frame) const;

  /// "parent>child" of each, in the order of the children.
  [[nodiscard]] std::vector<std::string> pairs() const;

 private:
  struct Parent {
    std::string frame;
    Eigen::Isometry3d T_parent_child;
  };

  /// A frame and those above it, from the lowest on, each with T_ancestor_frame. Ends where a damaged tree is a ring.
  [[nodiscard]] std::vector<Parent> ancestors(const std::string& frame) const;

  std::map<std::string, Parent> parents_;  ///< by the name of the child
};

}  // namespace dynamic_icp::datasets
