// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/joined_bag.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/byte_source.hpp"
#include "dynamic_icp/recording/bags/compression.hpp"
#include "dynamic_icp/recording/formats/memory_error.hpp"

namespace dynamic_icp::bags {
namespace {

class JoinedBag final : public Bag {
 public:
  JoinedBag(std::string_view container, std::vector<std::unique_ptr<FileBag>> parts, std::vector<std::string> notes)
      : container_(container), parts_(std::move(parts)), notes_(std::move(notes)) {
    std::map<std::uint64_t, Topic> channels;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      for (std::size_t topic = 0; topic < parts_[part]->topics().size(); ++topic) {
        channels[key(part, topic)] = parts_[part]->topics()[topic];
      }
      notes_.insert(notes_.end(), parts_[part]->notes().begin(), parts_[part]->notes().end());
    }
    table_ = table_of(channels);
  }

  [[nodiscard]] std::string_view container() const override { return container_; }
  [[nodiscard]] const std::vector<Topic>& topics() const override { return table_.topics; }
  [[nodiscard]] const std::vector<std::string>& notes() const override { return notes_; }

  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> wanted) const override {
    const std::vector<bool> is_wanted = chosen(wanted, table_.topics.size());
    std::vector<MessageEntry> entries;
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      std::vector<std::size_t> own;
      for (std::size_t topic = 0; topic < parts_[part]->topics().size(); ++topic) {
        if (is_wanted[table_.topic_of.at(key(part, topic))]) {
          own.push_back(topic);
        }
      }
      for (MessageEntry entry : parts_[part]->messages(own)) {
        entry.topic = table_.topic_of.at(key(part, entry.topic));
        entry.file = static_cast<std::uint32_t>(part);
        entries.push_back(entry);
      }
    }
    sort_by_time(entries);
    return entries;
  }

  [[nodiscard]] std::string read(const MessageEntry& entry) const override {
    return parts_.at(entry.file)->read(own(entry));
  }

  [[nodiscard]] std::string read_front(const MessageEntry& entry, std::size_t bytes) const override {
    return parts_.at(entry.file)->read_front(own(entry), bytes);
  }

  [[nodiscard]] std::filesystem::path file(const MessageEntry& entry) const override {
    return parts_.at(entry.file)->path();
  }

 private:
  /// As the part that holds it knows it.
  [[nodiscard]] MessageEntry own(const MessageEntry& entry) const {
    MessageEntry own = entry;
    own.file = 0;
    for (std::size_t topic = 0; topic < parts_[entry.file]->topics().size(); ++topic) {
      if (table_.topic_of.at(key(entry.file, topic)) == entry.topic) {
        own.topic = static_cast<std::uint32_t>(topic);
      }
    }
    return own;
  }

  static std::uint64_t key(std::size_t part, std::size_t topic) { return (std::uint64_t{part} << 32U) | topic; }

  std::string_view container_;
  std::vector<std::unique_ptr<FileBag>> parts_;
  std::vector<std::string> notes_;
  TopicTable table_;
};

class UnpackingBag final : public Bag {
 public:
  explicit UnpackingBag(std::unique_ptr<Bag> bag) : bag_(std::move(bag)) {}

  [[nodiscard]] std::string_view container() const override { return bag_->container(); }
  [[nodiscard]] const std::vector<Topic>& topics() const override { return bag_->topics(); }
  [[nodiscard]] const std::vector<std::string>& notes() const override { return bag_->notes(); }
  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> wanted) const override {
    return bag_->messages(wanted);
  }
  [[nodiscard]] std::filesystem::path file(const MessageEntry& entry) const override { return bag_->file(entry); }

  [[nodiscard]] std::string read(const MessageEntry& entry) const override {
    const std::string packed = bag_->read(entry);
    Unpacked message = formats::with_memory_for(file(entry), [&] { return unpack_zstd(packed, kMaxPieceBytes); });
    if (!message.fault.empty()) {
      throw DataError(
          fmt::format("{}: a message of {}: {}", file(entry).string(), topics()[entry.topic].name, message.fault));
    }
    return std::move(message.bytes);
  }

 private:
  std::unique_ptr<Bag> bag_;
};

using TopicNames = std::set<std::pair<std::string, std::string>>;

TopicNames names_of(const Bag& bag) {
  TopicNames names;
  for (const Topic& topic : bag.topics()) {
    names.emplace(topic.name, topic.type);
  }
  return names;
}

}  // namespace

std::unique_ptr<Bag> join_bags(std::string_view container, std::vector<std::unique_ptr<FileBag>> parts,
                               std::vector<std::string> notes) {
  return std::make_unique<JoinedBag>(container, std::move(parts), std::move(notes));
}

std::string why_not_one(const std::vector<std::unique_ptr<FileBag>>& parts) {
  std::vector<const FileBag*> sorted;
  TopicNames most;
  for (const auto& part : parts) {
    TopicNames names = names_of(*part);
    most = names.size() > most.size() ? std::move(names) : most;
    if (part->span()) {
      sorted.push_back(part.get());
    }
  }
  for (const auto& part : parts) {
    const TopicNames names = names_of(*part);
    if (!std::includes(most.begin(), most.end(), names.begin(), names.end())) {
      return "they do not hold the same topics";
    }
  }
  std::sort(sorted.begin(), sorted.end(),
            [](const FileBag* a, const FileBag* b) { return a->span()->first_ns < b->span()->first_ns; });
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const TimeSpan before = *sorted[k - 1]->span();
    const TimeSpan after = *sorted[k]->span();
    const auto length = [](const TimeSpan& span) {
      return static_cast<double>(span.last_ns) - static_cast<double>(span.first_ns);
    };
    // Messages that wait to be written make the parts of one recording overlap a little.
    const double overlap =
        static_cast<double>(std::min(before.last_ns, after.last_ns)) - static_cast<double>(after.first_ns);
    if (before.first_ns == after.first_ns || overlap > 0.5 * std::min(length(before), length(after))) {
      return fmt::format("{} and {} are of the same time", sorted[k - 1]->path().filename().string(),
                         sorted[k]->path().filename().string());
    }
  }
  return {};
}

std::unique_ptr<Bag> unpacking_messages(std::unique_ptr<Bag> bag) {
  return std::make_unique<UnpackingBag>(std::move(bag));
}

}  // namespace dynamic_icp::bags
