// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/followed_bag.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_dataset.hpp"
#include "dynamic_icp/recording/datasets/bag_truth.hpp"
#include "dynamic_icp/recording/datasets/correction.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kAskWhetherToStop{20};
constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMaxBytesBeforeOpen = std::uint64_t{4} << 30U;  // bytes of a stream
constexpr std::size_t kMaxMessagesBeforeOpen = 16'000'000;
constexpr std::uint64_t kLateTopic = 3;  // times as many clouds of another topic: a topic that is missing stays so

/// Of what else comes nothing is kept.
bool is_used(const bags::Topic& topic) {
  return messages::is_cloud(topic) || messages::is_transforms(topic) || messages::is_pose(topic);
}

class FollowedBag final : public FollowedDataset {
 public:
  FollowedBag(std::unique_ptr<bags::FollowedMcap> mcap, fs::path file, InputSettings settings, std::size_t first)
      : mcap_(std::move(mcap)),
        file_(std::move(file)),
        name_(mcap_->path()),
        settings_(std::move(settings)),
        first_(first) {
    check(settings_.correction);
    if (settings_.open.format != "auto" && settings_.open.format != "mcap") {
      throw UsageError(fmt::format("format '{}' cannot be followed in one file: expected mcap", settings_.open.format));
    }
    check_options("mcap", settings_.open);
    if (file_.empty() && !settings_.open.truth_topic.empty()) {
      throw UsageError(
          "truth-topic needs a recording that can be read again; of a stream state the file of the ground "
          "truth");
    }
    mcap_->keep_only(is_used);
  }

  bool wait_for(std::size_t index, const std::function<bool()>& stop) override {
    while (index >= size()) {
      if (mcap_->is_over() || !fault_.empty()) {
        return end();
      }
      if (stop()) {
        return false;
      }
      advance();
    }
    return true;
  }

  [[nodiscard]] std::optional<Arrival> arrival(std::size_t index) const override {
    const bags::MessageEntry& message = growing_->message(index);
    const auto found = arrivals_.find({message.place, message.offset});
    return found == arrivals_.end() ? std::nullopt : std::optional(found->second);
  }

  void release_before(std::size_t index) override {
    released_ = index;
    if (growing_ != nullptr) {
      const std::optional<bags::MessageEntry> needed = growing_->first_needed(index);
      mcap_->forget_before(needed);
      if (needed) {
        arrivals_.erase(arrivals_.begin(), arrivals_.lower_bound({needed->place, 0}));
      }
    }
  }

  std::vector<std::string> take_notes() override { return std::exchange(notes_, {}); }

  /// By then the file has an index, as a rule.
  void finish() override {
    const auto is_truth = [](const bags::Topic& topic) {
      return messages::is_pose(topic) && is_named_ground_truth(topic.name);
    };
    const bool has_truth = !settings_.open.truth_topic.empty() || mcap_->most_messages(is_truth) > 0;
    if (has_truth && file_.empty()) {
      notes_.push_back("the ground truth in a stream is not kept: state a file of it");
    } else if (has_truth) {
      whole_ = open_input(file_, settings_);
      for (const std::string& assumption : whole_->assumptions()) {
        if (assumption.find("ground truth") != std::string::npos) {
          notes_.push_back(assumption);
        }
      }
    }
  }

  [[nodiscard]] std::string_view format() const override { return "mcap"; }
  [[nodiscard]] std::size_t size() const override { return dataset_ ? dataset_->size() : 0; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return dataset_->stamp(index); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return dataset_->scan_file(index); }
  [[nodiscard]] RawScan scan(std::size_t index) const override { return dataset_->scan(index); }
  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override { return dataset_->columns(index); }
  [[nodiscard]] DopplerKind doppler_kind() const override { return dataset_->doppler_kind(); }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return with_truth().ground_truth(); }
  [[nodiscard]] fs::path ground_truth_file() const override { return with_truth().ground_truth_file(); }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return dataset_->assumptions(); }
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override {
    return dataset_->T_vehicle_sensor();
  }

 private:
  [[nodiscard]] const Dataset& with_truth() const { return whole_ ? *whole_ : *dataset_; }

  /// What there is to say at the end. False: no scan will come.
  bool end() {
    if (!fault_.empty()) {
      throw DataError(fault_);
    }
    if (!is_end_told_ && !mcap_->cut().empty()) {
      notes_.push_back(mcap_->cut());
    }
    is_end_told_ = true;
    return false;
  }

  /// Takes what has come; before it is opened record by record: what it is opened with depends on nothing else.
  void advance() {
    try {
      mcap_->advance(kAskWhetherToStop, dataset_ ? kAll : 1);
    } catch (const DataError& error) {
      fault_ = error.what();
    }
    if (!dataset_) {
      open();
    }
    if (dataset_) {
      take_new();
    } else {
      wait_on();
    }
  }

  /// Keeps what it will be opened with, but not without end.
  void wait_on() {
    mcap_->forget_before_new();
    if (mcap_->kept() > kMaxBytesBeforeOpen || mcap_->come() > kMaxMessagesBeforeOpen) {
      throw DataError(
          fmt::format("{}: {} MiB and {} messages of clouds, poses and transforms came and had to be kept before its "
                      "first {} clouds of points did, expected at most {} MiB and {}",
                      name_.string(), mcap_->kept() >> 20U, mcap_->come(), first_, kMaxBytesBeforeOpen >> 20U,
                      kMaxMessagesBeforeOpen));
    }
  }

  /// Opens what is there, once that is enough.
  void open() {
    const std::uint64_t clouds = mcap_->most_messages(messages::is_cloud);
    const std::vector<std::string>& names = settings_.open.topics;
    const bool is_over = mcap_->is_over();
    const bool is_late = is_over || clouds >= kLateTopic * first_;
    const bool is_enough =
        names.empty() ? clouds >= first_ : std::all_of(names.begin(), names.end(), [&](const std::string& name) {
          return mcap_->messages_of(name) >= first_;
        });
    if (!(is_enough || is_late) || (clouds == tried_with_ && !is_over)) {
      return;
    }
    tried_with_ = clouds;
    try {
      std::unique_ptr<GrowingBagDataset> opened = open_growing_bag(mcap_->bag(), name_, settings_.open);
      opened->settle(false);
      if (opened->size() < first_ && !is_late) {
        return;
      }
      growing_ = opened.get();
      dataset_ = corrected(std::move(opened), settings_.correction);
    } catch (const DataError& error) {
      const std::string& end = fault_.empty() ? mcap_->cut() : fault_;
      if (!end.empty()) {
        throw DataError(end);
      }
      if (is_late) {
        throw;
      }
    }
    in_bag_ = dataset_ ? mcap_->come() : 0;
  }

  void take_new() {
    for (const bags::FollowedMcap::NewMessage& message : mcap_->take_new()) {
      if (message.arrival) {
        arrivals_[{message.entry.place, message.entry.offset}] = *message.arrival;
      }
      if (in_bag_ > 0) {
        --in_bag_;
        continue;
      }
      try {
        growing_->add(message.entry);
      } catch (const DataError& error) {
        fault_ = fault_.empty() ? error.what() : fault_;
        break;
      }
    }
    growing_->settle(mcap_->is_over() || !fault_.empty());
    for (std::string& note : growing_->take_notes()) {
      notes_.push_back(std::move(note));
    }
    release_before(released_);
  }

  std::unique_ptr<bags::FollowedMcap> mcap_;
  fs::path file_;  ///< empty: a stream
  fs::path name_;  ///< for messages
  InputSettings settings_;
  std::size_t first_;
  std::uint64_t tried_with_ = 0;          ///< clouds, to open it
  std::unique_ptr<Dataset> dataset_;      ///< null: not opened yet
  GrowingBagDataset* growing_ = nullptr;  ///< within dataset_
  std::size_t in_bag_ = 0;                ///< messages of which dataset_ was made, and which are not taken yet
  std::size_t released_ = 0;
  std::map<std::pair<std::uint64_t, std::uint32_t>, Arrival> arrivals_;  ///< of messages by their places
  std::unique_ptr<Dataset> whole_;                                       ///< at the end, where there is a file
  std::string fault_;                                                    ///< why no more will come
  bool is_end_told_ = false;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<FollowedDataset> follow_bag(std::unique_ptr<bags::FollowedMcap> mcap, const fs::path& file,
                                            const InputSettings& settings, std::size_t first) {
  return std::make_unique<FollowedBag>(std::move(mcap), file, settings, first);
}

}  // namespace dynamic_icp::datasets
