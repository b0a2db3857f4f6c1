// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamic_icp/recording/bags/bag.hpp"
#include "dynamic_icp/recording/datasets/dataset.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"

namespace dynamic_icp::datasets {

/// The clouds of a bag as scans.
///
/// Taken is the topic of the options, else the only topic of clouds whose points have a Doppler by the names of their
/// fields (field_names.hpp). Several topics of the options are a rig: a scan for each cloud of the first topic, with
/// the nearest of each other one within half a period, moved into the frame of the first by the static transforms of
/// /tf_static; each point keeps its line of sight and the number of its topic.
///
/// Stamps are those of headers where these are sane (bag_stamps.hpp), the mounting is what /tf_static says, and ground
/// truth is what bag_truth.hpp finds. Opening reads the front of each cloud; memory grows with their number only.
///
/// `path` is what messages name for the whole bag. Throws DataError that lists the topics where there is no
/// cloud, UnclearInput where more than one, or none, could be meant; UsageError for topics that are not there.
std::unique_ptr<Dataset> open_bag_dataset(std::shared_ptr<const bags::Bag> bag, const std::filesystem::path& path,
                                          const OpenOptions& options);

/// The same of a bag that grows. What the first clouds say holds for all: topics, fields, the clock, mountings. There
/// is no ground truth: it may come later. One thread at a time.
class GrowingBagDataset : public Dataset {
 public:
  /// Takes over a message that came behind those of the bag and those before it, of whatever topic. Throws DataError
  /// where a cloud is damaged, or where a clock went back: then more than a few in a row are from before the last scan.
  virtual void add(const bags::MessageEntry& message) = 0;

  /// Makes scans of the clouds: of a rig once the other sensors have come that far, or do not come for three periods.
  /// `is_over`: no more will come.
  virtual void settle(bool is_over) = 0;

  /// The first message, in the order of the bag, that scans from `index` on need; nothing where none has come of them.
  [[nodiscard]] virtual std::optional<bags::MessageEntry> first_needed(std::size_t index) const = 0;

  /// The message of a scan, of a rig that of its first sensor.
  [[nodiscard]] virtual const bags::MessageEntry& message(std::size_t index) const = 0;

  /// Which messages were left out, and why, since it was asked last: sentences for the user.
  virtual std::vector<std::string> take_notes() = 0;
};

/// Opens what has come of a bag; throws as `open_bag_dataset` does. No scan is settled.
std::unique_ptr<GrowingBagDataset> open_growing_bag(std::shared_ptr<const bags::Bag> bag,
                                                    const std::filesystem::path& path, const OpenOptions& options);

}  // namespace dynamic_icp::datasets
