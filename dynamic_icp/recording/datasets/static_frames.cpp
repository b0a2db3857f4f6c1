// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/static_frames.hpp"

#include <algorithm>
#include <array>

#include "dynamic_icp/recording/datasets/folder_search.hpp"

namespace dynamic_icp::datasets {
namespace {

constexpr std::array<std::string_view, 8> kBaseNames = {"base_link", "base_footprint", "base", "vehicle", "ego_vehicle",
                                                        "car",       "rear_axle",      "body"};
constexpr std::array<std::string_view, 6> kWorldNames = {"map", "odom", "world", "earth", "utm", "enu"};

/// The name without the namespace in front.
std::string own_name(const std::string& frame) { return frame.substr(frame.rfind('/') + 1); }

template <class Names>
bool is_among(const Names& names, const std::string& frame) {
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view name) { return same_name(own_name(frame), name); });
}

}  // namespace

bool StaticFrames::is_world(const std::string& frame) { return is_among(kWorldNames, frame); }

void StaticFrames::add(const messages::StampedTransform& transform) {
  if (transform.child_frame_id != transform.header.frame_id) {
    parents_[transform.child_frame_id] = {transform.header.frame_id, transform.T_parent_child};
  }
}

std::vector<StaticFrames::Parent> StaticFrames::ancestors(const std::string& frame) const {
  std::vector<Parent> chain = {{frame, Eigen::Isometry3d::Identity()}};
  while (chain.size() <= parents_.size()) {
    const auto above = parents_.find(chain.back().frame);
    if (above == parents_.end()) {
      break;
    }
    chain.push_back({above->second.frame, above->second.T_parent_child * chain.back().T_parent_child});
  }
  return chain;
}

std::optional<Eigen::Isometry3d> StaticFrames::transform(const std::string& a, const std::string& b) const {
  const std::vector<Parent> above_b = ancestors(b);
  for (const Parent& common : ancestors(a)) {
    const auto found =
        std::find_if(above_b.begin(), above_b.end(), [&](const Parent& other) { return other.frame == common.frame; });
    if (found != above_b.end()) {
      return common.T_parent_child.inverse() * found->T_parent_child;
    }
  }
  return std::nullopt;
}

std::string StaticFrames::base_of(const std::string& frame) const {
  const std::vector<Parent> chain = ancestors(frame);
  for (const std::string_view name : kBaseNames) {
    for (std::size_t k = 1; k < chain.size(); ++k) {
      if (same_name(own_name(chain[k].frame), name)) {
        return chain[k].frame;
      }
    }
  }
  std::size_t top = 0;
  while (top + 1 < chain.size() && !is_world(chain[top + 1].frame)) {
    ++top;
  }
  return top == 0 ? std::string() : chain[top].frame;
}

std::vector<std::string> StaticFrames::pairs() const {
  std::vector<std::string> pairs;
  for (const auto& [child, parent] : parents_) {
    pairs.push_back(parent.frame + '>' + child);
  }
  return pairs;
}

}  // namespace dynamic_icp::datasets
