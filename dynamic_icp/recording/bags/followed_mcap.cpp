// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/followed_mcap.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "dynamic_icp/recording/bags/file_bag.hpp"
#include "dynamic_icp/recording/bags/mcap_pieces.hpp"
#include "dynamic_icp/recording/bags/mcap_scan.hpp"

namespace dynamic_icp::bags {
namespace {

bool is_same(const Topic& a, const Topic& b) {
  return a.name == b.name && a.type == b.type && a.encoding_name == b.encoding_name && a.schema == b.schema;
}

}  // namespace

/// A message, of a channel, and when it came.
struct FollowedMcap::Come {
  MessageEntry entry;
  std::optional<Arrival> arrival;
};

/// The bag of what has come until it was made.
class FollowedMcap::SoFar final : public FileBag {
 public:
  SoFar(std::shared_ptr<const McapPieces> pieces, const McapChannels& channels, const std::vector<Come>& messages)
      : FileBag("mcap", pieces->file().path()), pieces_(std::move(pieces)) {
    TopicTable table = table_of(channels.channels());
    topics_ = std::move(table.topics);
    topic_of_ = std::move(table.topic_of);
    for (const Come& message : messages) {
      entries_.push_back(*entry_of(message.entry, channels));
    }
  }

  /// The entry of a message of a channel; nothing where it is of none of the topics.
  std::optional<MessageEntry> entry_of(MessageEntry entry, const McapChannels& channels) {
    const auto known = topic_of_.find(entry.topic);
    if (known == topic_of_.end()) {  // another sender, perhaps of the same
      const Topic& topic = channels.channels().at(entry.topic);
      const auto found =
          std::find_if(topics_.begin(), topics_.end(), [&](const Topic& other) { return is_same(other, topic); });
      if (found == topics_.end()) {
        return std::nullopt;
      }
      topic_of_[entry.topic] = static_cast<std::uint32_t>(found - topics_.begin());
    }
    entry.topic = topic_of_.at(entry.topic);
    return entry;
  }

  [[nodiscard]] std::optional<TimeSpan> span() const override {
    const auto [first, last] = std::minmax_element(
        entries_.begin(), entries_.end(), [](const auto& a, const auto& b) { return a.recorded_ns < b.recorded_ns; });
    return entries_.empty() ? std::nullopt : std::optional(TimeSpan{first->recorded_ns, last->recorded_ns});
  }

  [[nodiscard]] std::vector<MessageEntry> messages(std::span<const std::size_t> wanted) const override {
    std::vector<MessageEntry> entries = of_topics(entries_, chosen(wanted, topics_.size()));
    sort_by_time(entries);
    return entries;
  }

  [[nodiscard]] std::string read(const MessageEntry& entry) const override { return read_front(entry, kMaxPieceBytes); }

  [[nodiscard]] std::string read_front(const MessageEntry& entry, std::size_t bytes) const override {
    return pieces_->message(entry, topic_of_, topics_.at(entry.topic).name, bytes);
  }

 private:
  std::shared_ptr<const McapPieces> pieces_;
  std::map<std::uint64_t, std::uint32_t> topic_of_;  // by channel
  std::vector<MessageEntry> entries_;
};

struct FollowedMcap::State {
  explicit State(std::shared_ptr<GrowingBytes> growing)
      : bytes(std::move(growing)), pieces(std::make_shared<McapPieces>(bytes)), scan(*pieces) {}

  /// Takes over what the scan saw.
  void take_seen() {
    for (const McapScan::Seen& seen : scan.take_seen()) {
      if (passes != nullptr && !passes(scan.channels().channels().at(seen.entry.topic))) {
        continue;
      }
      come.push_back({seen.entry, bytes->arrival(std::min(seen.end, bytes->size()))});
    }
    static_cast<void>(bytes->arrival(scan.at()));  // what is known of the time before is not needed any more
  }

  /// What is there of the last record.
  void take_cut() {
    if (scan.at() == 0) {
      cut = fmt::format("{}: ends at byte {}, before the mark of an MCAP file", bytes->path().string(), bytes->size());
      return;
    }
    try {
      scan.take_cut();
      if (!scan.has_ended()) {
        cut = fmt::format(
            "{}: ends at byte {}, before its end mark: the recording was not closed, or cut short between "
            "two records",
            bytes->path().string(), bytes->size());
      }
    } catch (const Damage& damage) {
      cut = fmt::format("{}: cut short at byte {}, within what begins at byte {} ({}): what comes before it is read",
                        bytes->path().string(), bytes->size(), damage.byte(), damage.reason());
    }
  }

  std::shared_ptr<GrowingBytes> bytes;
  std::shared_ptr<const McapPieces> pieces;
  McapScan scan;
  std::vector<Come> come;  ///< since they were taken
  bool (*passes)(const Topic& topic) = nullptr;
  std::shared_ptr<SoFar> bag;
  bool is_over = false;
  std::string cut;
};

FollowedMcap::FollowedMcap(std::unique_ptr<GrowingBytes> bytes) : state_(std::make_unique<State>(std::move(bytes))) {}
FollowedMcap::~FollowedMcap() = default;

void FollowedMcap::keep_only(bool (*passes)(const Topic& topic)) { state_->passes = passes; }

void FollowedMcap::advance(std::chrono::milliseconds longest, std::uint64_t most_records) {
  State& state = *state_;
  if (state.is_over) {
    return;
  }
  try {
    if (state.bytes->wait_for(state.scan.needed(), longest)) {
      state.scan.advance(most_records);
      const std::uint64_t missing = state.scan.needed() - state.scan.at();
      if (!state.scan.has_ended() && missing > kMaxPieceBytes + McapRecord::kHeadBytes) {
        throw Damage(state.bytes->path(), state.scan.at(),
                     fmt::format("a record of {} bytes, expected at most {}", missing, kMaxPieceBytes));
      }
    } else if (state.bytes->has_ended()) {
      state.take_cut();
      state.is_over = true;
    }
  } catch (const DataError&) {
    state.is_over = true;
    state.take_seen();
    throw;
  }
  state.take_seen();
  if (state.scan.has_ended()) {
    state.is_over = true;
    state.bytes->drain();
  }
}

bool FollowedMcap::is_over() const { return state_->is_over; }

const std::string& FollowedMcap::cut() const { return state_->cut; }

std::uint64_t FollowedMcap::most_messages(bool (*passes)(const Topic& topic)) const {
  std::uint64_t most = 0;
  for (const auto& [id, topic] : state_->scan.channels().channels()) {
    most = passes(topic) ? std::max(most, topic.messages) : most;
  }
  return most;
}

std::uint64_t FollowedMcap::messages_of(const std::string& name) const {
  std::uint64_t sum = 0;
  for (const auto& [id, topic] : state_->scan.channels().channels()) {
    sum += topic.name == name || topic.name == '/' + name ? topic.messages : 0;
  }
  return sum;
}

std::shared_ptr<const Bag> FollowedMcap::bag() {
  State& state = *state_;
  state.bag = std::make_shared<SoFar>(state.pieces, state.scan.channels(), state.come);
  return state.bag;
}

std::vector<FollowedMcap::NewMessage> FollowedMcap::take_new() {
  State& state = *state_;
  std::vector<NewMessage> taken;
  for (const Come& message : std::exchange(state.come, {})) {
    if (const std::optional<MessageEntry> entry = state.bag->entry_of(message.entry, state.scan.channels())) {
      taken.push_back({*entry, message.arrival});
    }
  }
  return taken;
}

std::size_t FollowedMcap::come() const { return state_->come.size(); }

const std::filesystem::path& FollowedMcap::path() const { return state_->bytes->path(); }

std::uint64_t FollowedMcap::kept() const { return state_->bytes->kept(); }

void FollowedMcap::forget_before_new() {
  forget_before(state_->come.empty() ? std::nullopt : std::optional(state_->come.front().entry));
}

void FollowedMcap::forget_before(const std::optional<MessageEntry>& entry) {
  state_->bytes->forget_before(entry ? entry->place : state_->scan.at());
}

}  // namespace dynamic_icp::bags
