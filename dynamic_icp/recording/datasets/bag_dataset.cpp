// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_dataset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_stamps.hpp"
#include "dynamic_icp/recording/datasets/bag_topic_choice.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/datasets/bag_truth.hpp"
#include "dynamic_icp/recording/datasets/calibration.hpp"
#include "dynamic_icp/recording/datasets/column_scan.hpp"
#include "dynamic_icp/recording/datasets/layouts.hpp"
#include "dynamic_icp/recording/datasets/message_columns.hpp"
#include "dynamic_icp/recording/datasets/named_rows.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kAbsent = std::numeric_limits<std::size_t>::max();

/// The clouds of one topic: its messages that are kept, and how they are read.
struct CloudTopic {
  std::string name;
  std::vector<bags::MessageEntry> entries;
  std::vector<std::size_t> numbers;  ///< of the messages among all of the topic
  std::vector<Stamp> stamps;
  std::string frame_id;
  Eigen::Isometry3d T_frame_cloud = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_scan_sensor = Eigen::Isometry3d::Identity();
  ColumnMeaning meaning;
};

/// Messages with the stamps in their headers.
struct Headers {
  std::vector<std::int64_t> recorded_ns;
  std::vector<Stamp> stamps;
};

class BagDataset final : public Dataset {
 public:
  BagDataset(std::shared_ptr<const bags::Bag> bag, const fs::path& path, const OpenOptions& options)
      : bag_(std::move(bag)), path_(path), assumptions_(bag_->notes()) {
    if (!options.sensors.empty()) {
      throw UsageError(
          fmt::format("sensors of a bag are chosen by their topics, not by name; sensor '{}' was asked for",
                      options.sensors.front()));
    }
    for (const std::string& name : choose_topics(*bag_, path_, options, assumptions_)) {
      topics_.emplace_back().name = name;
    }
    find_stamps();
    for (CloudTopic& topic : topics_) {
      find_meaning_of(topic, options);
    }
    const StaticFrames frames = read_frames();
    place_sensors(frames);
    take_calibration();
    group_scans();
    const CloudTopic& first = topics_.front();
    truth_ =
        bag_truth(*bag_, options.truth_topic, frames, {first.frame_id, first.T_frame_cloud, stamps_}, assumptions_);
    find_doppler_kind();
  }

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
    std::size_t rows = 0;
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      const std::size_t message = is_rig() ? groups_.at(index)[k] : index;
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
    }
    // A column that one of the sensors lacks is none of the scan.
    std::erase_if(columns, [&](const PointColumn& column) { return column.values.size() != rows; });
    return columns;
  }

 private:
  [[nodiscard]] bool is_rig() const { return topics_.size() > 1; }

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

  /// The header of a message, by its front where that tells.
  [[nodiscard]] messages::Header header_of(const bags::MessageEntry& entry, std::size_t number) const {
    const bags::Topic& topic = bag_->topics()[entry.topic];
    std::optional<messages::Header> header =
        messages::header_in_front(topic, bag_->read_front(entry, messages::kFrontBytes));
    return header ? std::move(*header)
                  : messages::decode_cloud(topic, bag_->read(entry), message_origin(*bag_, entry, number)).header;
  }

  /// All messages of a topic; those behind the first that cannot be read are left out, which is said.
  Headers read_headers(CloudTopic& topic) {
    topic.entries = bag_->messages(topics_named(*bag_, topic.name));
    std::erase_if(topic.entries, [&](const auto& entry) { return !messages::is_cloud(bag_->topics()[entry.topic]); });
    if (topic.entries.empty()) {
      throw DataError(fmt::format("{}: topic '{}' has no messages", path_.string(), topic.name));
    }
    Headers headers;
    for (std::size_t i = 0; i < topic.entries.size(); ++i) {
      try {
        headers.stamps.push_back(header_of(topic.entries[i], i).stamp);
      } catch (const DataError& error) {
        if (i == 0) {
          throw;
        }
        assumptions_.push_back(fmt::format("{}: this message and the {} behind it are left out", error.what(),
                                           topic.entries.size() - i - 1));
        topic.entries.resize(i);
        break;
      }
      headers.recorded_ns.push_back(topic.entries[i].recorded_ns);
    }
    return headers;
  }

  /// One clock for all topics: where one has to go by the times of recording, all do.
  void find_stamps() {
    std::vector<Headers> headers;
    std::vector<ChosenStamps> chosen;
    for (CloudTopic& topic : topics_) {
      headers.push_back(read_headers(topic));
      chosen.push_back(choose_stamps(headers.back().recorded_ns, headers.back().stamps, topic.name));
    }
    const bool are_recorded =
        std::any_of(chosen.begin(), chosen.end(), [](const ChosenStamps& c) { return c.are_recorded; });
    for (std::size_t k = 0; k < topics_.size(); ++k) {
      CloudTopic& topic = topics_[k];
      if (are_recorded && !chosen[k].are_recorded) {
        chosen[k] = recorded_stamps(headers[k].recorded_ns, topic.name);
      }
      assumptions_.insert(assumptions_.end(), chosen[k].assumptions.begin(), chosen[k].assumptions.end());
      std::vector<bags::MessageEntry> kept;
      for (const std::size_t message : chosen[k].kept) {
        kept.push_back(topic.entries[message]);
      }
      topic.entries = std::move(kept);
      topic.numbers = std::move(chosen[k].kept);
      topic.stamps = std::move(chosen[k].stamps);
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
    topic.meaning = find_meaning(
        map_columns(*open(topic, 0).columns, options.fields, fmt::format("{}: {}", path_.string(), topic.name), {}),
        topic.entries.size(), [&](std::size_t message) { return open(topic, message); },
        period_of(topic, options.period_s), assumptions_);
  }

  static double period_of(const CloudTopic& topic, double otherwise_s) {
    std::vector<double> periods;
    for (std::size_t i = 1; i < topic.stamps.size(); ++i) {
      periods.push_back(seconds_between(topic.stamps[i - 1], topic.stamps[i]));
    }
    if (periods.empty()) {
      return otherwise_s;
    }
    const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
    std::nth_element(periods.begin(), middle, periods.end());
    return *middle;
  }

  StaticFrames read_frames() {
    try {
      return read_static_frames(*bag_);
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
                        "needs the static transforms between them in /tf_static; there are: {}",
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

  /// For each cloud of the first topic the nearest of the others.
  void group_scans() {
    stamps_ = topics_.front().stamps;
    if (!is_rig()) {
      return;
    }
    groups_.assign(stamps_.size(), std::vector<std::size_t>(topics_.size(), kAbsent));
    const double half_period_s = 0.5 * period_of(topics_.front(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < stamps_.size(); ++i) {
      groups_[i][0] = i;
    }
    for (std::size_t k = 1; k < topics_.size(); ++k) {
      const std::size_t without = group_topic(k, half_period_s);
      if (without > 0) {
        assumptions_.push_back(fmt::format("topic '{}': {} of {} scans have no cloud of it within half a period",
                                           topics_[k].name, without, stamps_.size()));
      }
    }
    has_times_ = std::any_of(topics_.begin(), topics_.end(),
                             [](const CloudTopic& topic) { return topic.meaning.fields.time.has_value(); });
  }

  /// How many scans found no cloud of a topic. A cloud serves one scan, the nearest.
  std::size_t group_topic(std::size_t k, double half_period_s) {
    const std::vector<Stamp>& stamps = topics_[k].stamps;
    const auto distance_s = [&](std::size_t scan, std::size_t message) {
      return std::abs(seconds_between(stamps_[scan], stamps[message]));
    };
    std::size_t without = 0;
    std::size_t message = 0;
    for (std::size_t i = 0; i < stamps_.size(); ++i) {
      while (message + 1 < stamps.size() && distance_s(i, message + 1) <= distance_s(i, message)) {
        ++message;
      }
      const bool is_nearer_to_next = i + 1 < stamps_.size() && distance_s(i + 1, message) < distance_s(i, message);
      if (distance_s(i, message) <= half_period_s && !is_nearer_to_next) {
        groups_[i][k] = message;
      } else {
        ++without;
      }
    }
    return without;
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
      const std::size_t message = groups_[index][k];
      if (message != kAbsent) {
        append(scan_of(topics_[k], message), k, rig);
      }
    }
    const auto drop_partial = [&](auto& column) {
      column.resize(column.size() == rig.points.size() ? column.size() : 0);
    };
    drop_partial(rig.channels.line);
    drop_partial(rig.channels.face);
    drop_partial(rig.channels.intensity);
    drop_partial(rig.channels.return_number);
    return rig;
  }

  /// Adds the points of a sensor. A column that one of the sensors lacks stays too short, and is dropped at the end.
  void append(const RawScan& scan, std::size_t sensor, RawScan& rig) const {
    const std::size_t before = rig.points.size();
    const Eigen::Isometry3d& T = topics_[sensor].T_scan_sensor;
    const double later_s = seconds_between(rig.stamp, scan.stamp);
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Eigen::Vector3d& point = scan.points[i];
      // No line of sight leads to the sensor's own origin: the zero that stays here marks the point as unusable.
      const Eigen::Vector3d line_of_sight = scan.directions.empty() ? point.stableNormalized() : scan.directions[i];
      rig.points.emplace_back(T * point);
      rig.directions.emplace_back(T.linear() * line_of_sight);
      if (has_times_) {
        rig.times.push_back(later_s + (scan.times.empty() ? 0.0 : scan.times[i]));
      }
    }
    const auto add = [&](const auto& from, auto& to) {
      if (to.size() == before) {
        to.insert(to.end(), from.begin(), from.end());
      }
    };
    add(scan.doppler, rig.doppler);
    add(scan.channels.line, rig.channels.line);
    add(scan.channels.face, rig.channels.face);
    add(scan.channels.intensity, rig.channels.intensity);
    add(scan.channels.return_number, rig.channels.return_number);
    if (!scan.is_unusable.empty() || !rig.is_unusable.empty()) {
      rig.is_unusable.resize(before, 0);
      rig.is_unusable.insert(rig.is_unusable.end(), scan.is_unusable.begin(), scan.is_unusable.end());
      rig.is_unusable.resize(rig.points.size(), 0);
    }
    rig.channels.sensor.resize(rig.points.size(), static_cast<std::uint8_t>(sensor));
    if (!scan.warning.empty()) {
      rig.warning += (rig.warning.empty() ? "" : "; ") + scan.warning;
    }
  }

  std::shared_ptr<const bags::Bag> bag_;
  fs::path path_;
  std::vector<std::string> assumptions_;
  std::vector<CloudTopic> topics_;
  std::vector<Stamp> stamps_;                     ///< of the scans
  std::vector<std::vector<std::size_t>> groups_;  ///< of a rig: the clouds of each scan, by topic
  bool has_times_ = false;                        ///< a rig with times of points
  std::optional<Eigen::Isometry3d> T_vehicle_sensor_;
  std::vector<Eigen::Isometry3d> mountings_;  ///< of one topic whose points name their sensors
  DopplerKind doppler_kind_ = DopplerKind::kRelative;
  Truth truth_;
};

}  // namespace

std::unique_ptr<Dataset> open_bag_dataset(std::shared_ptr<const bags::Bag> bag, const fs::path& path,
                                          const OpenOptions& options) {
  return std::make_unique<BagDataset>(std::move(bag), path, options);
}

fs::path find_rosbag(const fs::path& input) { return bags::find_bag(input, "rosbag"); }

fs::path find_rosbag2(const fs::path& input) { return bags::find_bag(input, "rosbag2"); }

fs::path find_mcap(const fs::path& input) { return bags::find_bag(input, "mcap"); }

std::unique_ptr<Dataset> open_bag(const fs::path& found, const OpenOptions& options) {
  return open_bag_dataset(bags::open_bag(found), found, options);
}

}  // namespace dynamic_icp::datasets
