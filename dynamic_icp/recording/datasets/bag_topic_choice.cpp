// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/bag_topic_choice.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/bag_topics.hpp"
#include "dynamic_icp/recording/datasets/bag_transforms.hpp"
#include "dynamic_icp/recording/datasets/field_names.hpp"
#include "dynamic_icp/recording/datasets/message_columns.hpp"
#include "dynamic_icp/recording/datasets/named_rows.hpp"
#include "dynamic_icp/recording/datasets/unclear_input.hpp"
#include "dynamic_icp/recording/messages/messages.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> field_names_of(const std::vector<messages::PointField>& fields) {
  std::vector<std::string> names;
  for (const messages::PointField& field : fields) {
    names.push_back(field.name);
  }
  return names;
}

bool has_doppler(const TopicSummary& topic, const OpenOptions& options) {
  try {
    map_fields(field_names_of(topic.fields), options.fields, topic.name);
    return true;
  } catch (const DataError&) {
    return false;
  }
}

std::string listed_topics(const std::vector<TopicSummary>& topics) {
  std::string text;
  for (const TopicSummary& topic : topics) {
    text += "\n  " + topic_line(topic);
  }
  return text.empty() ? " none" : text;
}

/// Whether the static transforms say where the sensors of all these clouds sit, each elsewhere.
bool are_placed(const std::vector<TopicSummary>& clouds, const StaticFrames& frames) {
  constexpr double kSamePlace = 1e-9;
  const TopicSummary& first = clouds.front();
  return std::all_of(clouds.begin() + 1, clouds.end(), [&](const TopicSummary& other) {
    const bool have_frames = !first.frame_id.empty() && !other.frame_id.empty();
    const std::optional<Eigen::Isometry3d> T_first_other =
        have_frames ? frames.transform(first.frame_id, other.frame_id) : std::nullopt;
    return T_first_other && !T_first_other->matrix().isIdentity(kSamePlace);
  });
}

/// The same of a bag.
bool are_placed(const std::vector<TopicSummary>& clouds, const bags::Bag& bag) {
  try {
    StaticFrames frames = read_static_frames(bag);
    return are_placed(clouds, frames) || (add_repeated_frames(bag, frames) > 0 && are_placed(clouds, frames));
  } catch (const DataError&) {  // transforms that cannot be read place nothing
    return false;
  }
}

/// Proposes all clouds as a rig where they are one, and each alone.
[[noreturn]] void ask_which(const fs::path& path, const std::vector<TopicSummary>& clouds, const bags::Bag& bag) {
  const std::string text = fmt::format("{}: holds several clouds of points with Doppler", path.string());
  UnclearInput::Settings all;
  std::vector<UnclearInput::Settings> each;
  for (const TopicSummary& cloud : clouds) {
    all.emplace_back("topic.", cloud.name);
    each.push_back({{"topic.", cloud.name}});
  }
  if (are_placed(clouds, bag)) {
    throw UnclearInput(fmt::format("{}, and transforms that say where their sensors sit: name the topics of all as a "
                                   "rig, or that of one:{}",
                                   text, listed_topics(clouds)),
                       std::move(all), std::move(each));
  }
  throw UnclearInput(fmt::format("{}; name the topic of one (several make a rig where /tf_static has the transforms "
                                 "between their frames):{}",
                                 text, listed_topics(clouds)),
                     each.front(), {each.begin() + 1, each.end()});
}

/// The topics to take.
class TopicChoice {
 public:
  TopicChoice(const bags::Bag& bag, const fs::path& path, const OpenOptions& options)
      : bag_(bag), path_(path), options_(options) {}

  std::vector<std::string> choose(std::vector<std::string>& assumptions) const {
    return options_.topics.empty() ? std::vector{only_one(assumptions)} : wanted();
  }

 private:
  [[nodiscard]] std::vector<std::string> wanted() const {
    std::vector<std::string> chosen;
    for (const std::string& name : options_.topics) {
      const std::vector<std::size_t> found = topics_named(bag_, name);
      if (std::none_of(found.begin(), found.end(),
                       [&](std::size_t k) { return messages::is_cloud(bag_.topics()[k]); })) {
        const std::vector<std::string> clouds = topic_names(bag_, messages::is_cloud);
        throw UsageError(fmt::format(
            "{}: {}; topics of clouds: {}", path_.string(),
            found.empty() ? fmt::format("no topic '{}'", name)
                          : fmt::format("topic '{}' is of {} ({}), which is read as no cloud of points", name,
                                        bag_.topics()[found.front()].type, bag_.topics()[found.front()].encoding_name),
            clouds.empty() ? "none" : fmt::format("{}", fmt::join(clouds, ", "))));
      }
      chosen.push_back(bag_.topics()[found.front()].name);
      if (std::count(chosen.begin(), chosen.end(), chosen.back()) > 1) {
        throw UsageError(fmt::format("topic '{}' for the second time", name));
      }
    }
    return chosen;
  }

  /// Throws what may be meant by the first cloud that has a candidate.
  [[noreturn]] void refuse_all(const std::vector<TopicSummary>& clouds) const {
    const std::string what = fmt::format(
        "{}: no cloud of points has coordinates and a Doppler by the names of its fields; name topic and field of "
        "one:{}",
        path_.string(), listed_topics(clouds));
    for (const TopicSummary& cloud : clouds) {
      if (UnclearInput::Settings proposal = proposal_for(cloud.name); !proposal.empty()) {
        proposal.insert(proposal.begin(), {"topic.", cloud.name});
        throw UnclearInput(what, std::move(proposal));
      }
    }
    throw DataError(what);
  }

  /// Fields of the first message of a topic that may be meant; empty: none.
  [[nodiscard]] UnclearInput::Settings proposal_for(const std::string& name) const {
    try {
      const std::vector<std::size_t> topics = topics_named(bag_, name);
      const bags::MessageEntry entry = bag_.messages(topics).at(0);
      const MessageColumns columns(
          messages::CloudColumns(messages::decode_cloud(bag_.topics()[entry.topic], bag_.read(entry), name), name));
      map_columns(columns, options_.fields, name, {});
    } catch (const UnclearInput& error) {
      return error.proposal();
    } catch (const DataError&) {  // what cannot be read is no proposal
    }
    return {};
  }

  [[nodiscard]] std::string only_one(std::vector<std::string>& assumptions) const {
    std::vector<TopicSummary> clouds = summarize_bag(bag_, path_).topics;
    const std::vector<TopicSummary> all = clouds;
    std::erase_if(clouds, [](const TopicSummary& topic) { return !topic.is_cloud || topic.messages == 0; });
    if (clouds.empty()) {
      throw DataError(
          fmt::format("{}: holds no clouds of points (sensor_msgs/PointCloud2, sensor_msgs/PointCloud, "
                      "radar_msgs/RadarScan or foxglove.PointCloud); its topics:{}",
                      path_.string(), listed_topics(all)));
    }
    std::vector<TopicSummary> usable = clouds;
    std::erase_if(usable, [&](const TopicSummary& topic) { return !has_doppler(topic, options_); });
    if (usable.empty() && clouds.size() == 1 && clouds.front().fault.empty()) {
      return clouds.front().name;  // whose columns say what they lack
    }
    if (usable.empty()) {
      refuse_all(clouds);
    }
    const std::size_t definitions = usable.size();  // of one topic there may be several
    const auto same_name = [](const TopicSummary& a, const TopicSummary& b) { return a.name == b.name; };
    usable.erase(std::unique(usable.begin(), usable.end(), same_name), usable.end());
    if (usable.size() > 1) {
      ask_which(path_, usable, bag_);
    }
    if (clouds.size() > definitions) {
      assumptions.push_back(
          fmt::format("topic '{}' is taken: of {} clouds of points it alone has a Doppler by the names of its fields",
                      usable.front().name, clouds.size()));
    }
    return usable.front().name;
  }

  const bags::Bag& bag_;
  const fs::path& path_;
  const OpenOptions& options_;
};

}  // namespace

std::vector<std::string> choose_topics(const bags::Bag& bag, const fs::path& path, const OpenOptions& options,
                                       std::vector<std::string>& assumptions) {
  return TopicChoice(bag, path, options).choose(assumptions);
}

}  // namespace dynamic_icp::datasets
