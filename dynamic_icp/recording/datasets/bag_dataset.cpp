// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_dataset.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_clouds.hpp"
#include "dynamic_icp/recording/datasets/bag_groups.hpp"
#include "dynamic_icp/recording/datasets/bag_topic_choice.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/datasets/bag_transforms.hpp"
#include "dynamic_icp/recording/datasets/bag_truth.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/message_columns.hpp"
#include "dynamic_icp/recording/datasets/named_rows.hpp"
#include "dynamic_icp/recording/datasets/rig_scan.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kClockWentBack = 10;  // messages in a row from before the last scan

class BagDataset final : public GrowingBagDataset {
 public:
  BagDataset(std::shared_ptr<const bags::Bag> bag, const fs::path& path, const OpenOptions& options, bool grows)
      : bag_(std::move(bag)), path_(path), assumptions_(bag_->notes()) {
    if (!options.sensors.empty()) {
      throw UsageError(
          fmt::format("sensors of a bag are chosen by their topics, not by name; sensor '{}' was asked for",
                      options.sensors.front()));
    }
    for (const std::string& name : choose_topics(*bag_, path_, options, assumptions_)) {
      topics_.emplace_back().name = name;
    }
    find_clouds(*bag_, path_, topics_, assumptions_);
    for (CloudTopic& topic : topics_) {
      find_meaning_of(topic, options);
    }
    const StaticFrames frames = read_frames();
    place_sensors(frames);
    take_calibration();
    has_times_ = std::any_of(topics_.begin(), topics_.end(),
                             [](const CloudTopic& topic) { return topic.meaning.fields.time.has_value(); });
    half_period_s_ = 0.5 * period_of(topics_.front(), std::numeric_limits<double>::infinity());
    find_doppler_kind();
    if (grows) {
      return;
    }
    settle(true);
    tell_absent();
    const CloudTopic& first = topics_.front();
    truth_ =
        bag_truth(*bag_, options.truth_topic, frames, {first.frame_id, first.T_frame_cloud, stamps_}, assumptions_);
  }

  void add(const bags::MessageEntry& message) override {
    const std::string& name = bag_->topics()[message.topic].name;
    const auto topic =
        std::find_if(topics_.begin(), topics_.end(), [&](const CloudTopic& one) { return one.name == name; });
    if (topic == topics_.end() || !messages::is_cloud(bag_->topics()[message.topic])) {
      return;
    }
    const std::string left_out = add_cloud(*bag_, *topic, message);
    if (left_out.empty()) {
      left_out_in_a_row_ = 0;
    } else if (notes_.push_back(left_out); ++left_out_in_a_row_ > kClockWentBack) {
      throw DataError(fmt::format("{}: the clock of '{}' went back", left_out, name));
    }
  }

  void settle(bool is_over) override {
    const CloudTopic& first = topics_.front();
    while (stamps_.size() < first.stamps.size() && (is_over || is_settled(topics_, stamps_.size()))) {
      if (is_rig()) {
        groups_.push_back(nearest_clouds(topics_, stamps_.size(), half_period_s_));
      }
      stamps_.push_back(first.stamps[stamps_.size()]);
    }
  }

  [[nodiscard]] std::optional<bags::MessageEntry> first_needed(std::size_t index) const override {
    const CloudTopic& first = topics_.front();
    if (index >= first.entries.size()) {
      return std::nullopt;
    }
    bags::MessageEntry needed = first.entries[index];
    for (const CloudTopic& topic : topics_) {
      const std::size_t before = last_before(topic.stamps, first.stamps[index]);
      if (before < topic.entries.size() && topic.entries[before].place < needed.place) {
        needed = topic.entries[before];
      }
    }
    return needed;
  }

  [[nodiscard]] const bags::MessageEntry& message(std::size_t index) const override {
    return topics_.front().entries.at(index);
  }

  std::vector<std::string> take_notes() override { return std::exchange(notes_, {}); }

  [[nodiscard]] std::string_view format() const override { return bag_->container(); }
  [[nodiscard]] std::size_t size() const override { return stamps_.size(); }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return stamps_.at(index); }
  [[nodiscard]] DopplerKind doppler_kind() const override { return doppler_kind_; }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return truth_.poses; }
  [[nodiscard]] fs::path ground_truth_file() const override { return truth_.file; }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return assumptions_; }
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override { return T_vehicle_sensor_; }

  [[nodiscard]] fs::path scan_file(std::size_t index) const override {
    return bag_->file(topics_.front().entries.at(index));
  }

  [[nodiscard]] RawScan scan(std::size_t index) const override {
    RawScan raw = is_rig() ? rig_scan(index) : scan_of(topics_.front(), index);
    if (!is_rig()) {
      set_mountings(topics_.front(), index, raw);
    }
    raw.doppler_kind = doppler_kind_;
    return raw;
  }

  [[nodiscard]] std::vector<PointColumn> columns(std::size_t index) const override {
    std::vector<PointColumn> columns;
    PointColumn sensor{"sensor", {}, true};  // that no message has: its topic says it
    std::size_t rows = 0;
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      const std::size_t message = message_of(index, k);
      if (message == kAbsent) {
        continue;
      }
      const CloudTopic& topic = topics_[k];
      const ColumnsOfScan opened = open(topic, message);
      const std::size_t points = formats::rows_of(opened.columns->read(topic.meaning.fields.doppler.array));
      for (PointColumn& column : other_columns(*opened.columns, topic.meaning.fields, opened.origin)) {
        append_column(columns, rows, std::move(column));
      }
      rows += points;
      sensor.values.resize(rows, static_cast<double>(k));
    }
    // A column that one of the sensors lacks is none of the scan; what its points call their sensor is not the rig's.
    std::erase_if(columns, [&](const PointColumn& column) {
      return column.values.size() != rows || (is_rig() && column.name == sensor.name);
    });
    if (is_rig()) {
      columns.push_back(std::move(sensor));
    }
    return columns;
  }

 private:
  [[nodiscard]] bool is_rig() const { return topics_.size() > 1; }

  /// The cloud of a topic in a scan; kAbsent: none.
  [[nodiscard]] std::size_t message_of(std::size_t index, std::size_t topic) const {
    return topic == 0 ? index : groups_.at(index)[topic - 1];
  }

  static void append_column(std::vector<PointColumn>& columns, std::size_t rows_before, PointColumn column) {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const PointColumn& c) { return c.name == column.name; });
    if (found != columns.end() && found->values.size() == rows_before) {
      found->values.insert(found->values.end(), column.values.begin(), column.values.end());
      found->is_integer = found->is_integer && column.is_integer;
    } else if (found == columns.end() && rows_before == 0) {
      columns.push_back(std::move(column));
    }
  }

  [[nodiscard]] messages::PointCloud cloud_of(const CloudTopic& topic, std::size_t message) const {
    const bags::MessageEntry& entry = topic.entries.at(message);
    return messages::decode_cloud(bag_->topics()[entry.topic], bag_->read(entry),
                                  message_origin(*bag_, entry, topic.numbers[message]));
  }

  [[nodiscard]] ColumnsOfScan open(const CloudTopic& topic, std::size_t message) const {
    std::string origin = message_origin(*bag_, topic.entries.at(message), topic.numbers[message]);
    return {std::make_unique<MessageColumns>(messages::CloudColumns(cloud_of(topic, message), origin)), origin};
  }

  void find_meaning_of(CloudTopic& topic, const OpenOptions& options) {
    const messages::PointCloud first = cloud_of(topic, 0);
    topic.frame_id = first.header.frame_id;
    topic.T_frame_cloud = first.T_frame_cloud.value_or(Eigen::Isometry3d::Identity());
    const std::string origin = fmt::format("{}: {}", path_.string(), topic.name);
    FieldMap fields = map_columns(*open(topic, 0).columns, options.fields, origin, {});
    refuse_stated_columns(fields, options, origin);
    topic.meaning = find_meaning(
        std::move(fields), topic.entries.size(), [&](std::size_t message) { return open(topic, message); },
        period_of(topic, options.period_s), assumptions_);
  }

  /// What /tf repeats is sought only where /tf_static leaves a sensor in the air: such a bag may be long.
  StaticFrames read_frames() {
    try {
      StaticFrames frames = read_static_frames(*bag_);
      const bool is_known = std::all_of(topics_.begin(), topics_.end(), [&](const CloudTopic& topic) {
        return topic.frame_id.empty() || !frames.base_of(topic.frame_id).empty();
      });
      if (const std::size_t added = is_known ? 0 : add_repeated_frames(*bag_, frames); added > 0) {
        assumptions_.push_back(
            fmt::format("{} transforms that topics of moving ones repeat without change are taken as static", added));
      }
      return frames;
    } catch (const DataError& error) {
      assumptions_.push_back(fmt::format("static transforms are not used: {}", error.what()));
      return {};
    }
  }

  void place_sensors(const StaticFrames& frames) {
    const CloudTopic& first = topics_.front();
    if (const std::string base = frames.base_of(first.frame_id); !base.empty()) {
      T_vehicle_sensor_ = *frames.transform(base, first.frame_id) * first.T_frame_cloud;
      assumptions_.push_back(
          fmt::format("the mounting is that of frame '{}' on '{}' by the static transforms", first.frame_id, base));
    }
    for (std::size_t k = 1; k < topics_.size(); ++k) {
      CloudTopic& topic = topics_[k];
      const std::optional<Eigen::Isometry3d> T_first_other = topic.frame_id.empty() || first.frame_id.empty()
                                                                 ? std::nullopt
                                                                 : frames.transform(first.frame_id, topic.frame_id);
      if (!T_first_other) {
        const std::vector<std::string> pairs = frames.pairs();
        throw DataError(
            fmt::format("{}: where topic '{}' (frame '{}') is seen from '{}' (frame '{}') is not known: a rig "
                        "needs the transforms between them in /tf_static, or in /tf without change; there are: {}",
                        path_.string(), topic.name, topic.frame_id, first.name, first.frame_id,
                        pairs.empty() ? "none" : fmt::format("{}", fmt::join(pairs, ", "))));
      }
      topic.T_scan_sensor = first.T_frame_cloud.inverse() * *T_first_other * topic.T_frame_cloud;
      if (topic.T_scan_sensor.matrix().isIdentity(1e-9)) {
        throw DataError(
            fmt::format("{}: topics '{}' and '{}' are in one frame, '{}': where the sensor of each sits, which "
                        "their Doppler depends on, is not known",
                        path_.string(), first.name, topic.name, topic.frame_id));
      }
    }
    if (is_rig()) {
      assumptions_.push_back(fmt::format("{} topics are merged into frame '{}' of topic '{}'", topics_.size(),
                                         first.frame_id, first.name));
    }
  }

  /// What a converted recording says of its mountings, exactly: transforms may say it too.
  void take_calibration() {
    for (std::size_t k = 0; k < bag_->topics().size(); ++k) {
      const bags::Topic& topic = bag_->topics()[k];
      if (topic.type != "dynamic_icp.Calibration" || topic.encoding != bags::Encoding::kJson) {
        continue;
      }
      const std::vector<bags::MessageEntry> entries = bag_->messages(std::array{k});
      if (entries.empty() || is_rig()) {
        return;
      }
      Calibration calibration =
          parse_calibration(bag_->read(entries.front()), message_origin(*bag_, entries.front(), 0));
      T_vehicle_sensor_ = calibration.T_vehicle_sensor ? calibration.T_vehicle_sensor : T_vehicle_sensor_;
      mountings_ = std::move(calibration.mountings);
      return;
    }
  }

  /// Of one topic whose points name their sensors.
  void set_mountings(const CloudTopic& topic, std::size_t message, RawScan& raw) const {
    const std::vector<std::uint8_t>& sensor = raw.channels.sensor;
    if (mountings_.empty() || (sensor.empty() && !raw.points.empty())) {
      return;
    }
    const auto unknown =
        std::find_if(sensor.begin(), sensor.end(), [&](std::size_t k) { return k >= mountings_.size(); });
    if (unknown != sensor.end()) {
      throw DataError(fmt::format("{}: point {} is of sensor {}, but the calibration has {} sensors, counted from 0",
                                  message_origin(*bag_, topic.entries.at(message), topic.numbers[message]),
                                  unknown - sensor.begin(), *unknown, mountings_.size()));
    }
    raw.mountings = mountings_;
  }

  void tell_absent() {
    for (std::size_t k = 1; k < topics_.size(); ++k) {
      const auto without =
          std::count_if(groups_.begin(), groups_.end(), [&](const auto& group) { return group[k - 1] == kAbsent; });
      if (without > 0) {
        assumptions_.push_back(fmt::format("topic '{}': {} of {} scans have no cloud of it within half a period",
                                           topics_[k].name, without, stamps_.size()));
      }
    }
  }

  void find_doppler_kind() {
    for (const CloudTopic& topic : topics_) {
      if (topic.name.find("compensated") != std::string::npos &&
          topic.name.find("uncompensated") == std::string::npos) {
        doppler_kind_ = DopplerKind::kCompensated;
        assumptions_.push_back(
            fmt::format("the Doppler is taken as compensated, by the name of topic '{}'", topic.name));
        return;
      }
    }
  }

  [[nodiscard]] RawScan scan_of(const CloudTopic& topic, std::size_t message) const {
    const ColumnsOfScan opened = open(topic, message);
    return read_scan(*opened.columns, topic.meaning, topic.stamps[message], opened.origin);
  }

  [[nodiscard]] RawScan rig_scan(std::size_t index) const {
    RawScan rig;
    rig.stamp = stamps_.at(index);
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      rig.mountings.push_back(topics_[k].T_scan_sensor);
      if (const std::size_t message = message_of(index, k); message != kAbsent) {
        append_sensor(scan_of(topics_[k], message), k, has_times_, rig);
      }
    }
    drop_partial_channels(rig);
    return rig;
  }

  std::shared_ptr<const bags::Bag> bag_;
  fs::path path_;
  std::vector<std::string> assumptions_;
  std::vector<CloudTopic> topics_;
  std::vector<Stamp> stamps_;                     ///< of the scans, as far as they are settled
  std::vector<std::vector<std::size_t>> groups_;  ///< of a rig: the clouds of each scan, by topic behind the first
  bool has_times_ = false;                        ///< a rig with times of points
  std::optional<Eigen::Isometry3d> T_vehicle_sensor_;
  std::vector<Eigen::Isometry3d> mountings_;  ///< of one topic whose points name their sensors
  DopplerKind doppler_kind_ = DopplerKind::kRelative;
  Truth truth_;
  double half_period_s_ = 0.0;
  std::size_t left_out_in_a_row_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<Dataset> open_bag_dataset(std::shared_ptr<const bags::Bag> bag, const fs::path& path,
                                          const OpenOptions& options) {
  return std::make_unique<BagDataset>(std::move(bag), path, options, false);
}

std::unique_ptr<GrowingBagDataset> open_growing_bag(std::shared_ptr<const bags::Bag> bag, const fs::path& path,
                                                    const OpenOptions& options) {
  return std::make_unique<BagDataset>(std::move(bag), path, options, true);
}

fs::path find_rosbag(const fs::path& input) { return bags::find_bag(input, "rosbag"); }

fs::path find_rosbag2(const fs::path& input) { return bags::find_bag(input, "rosbag2"); }

fs::path find_mcap(const fs::path& input) { return bags::find_bag(input, "mcap"); }

std::unique_ptr<Dataset> open_bag(const fs::path& found, const OpenOptions& options) {
  return open_bag_dataset(bags::open_bag(found), found, options);
}

}  // namespace dynamic_icp::datasets
