// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/followed_folder.hpp"

#include <algorithm>
#include <map>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/datasets/not_a_recording.hpp"

namespace dynamic_icp::datasets {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using std::chrono::system_clock;

constexpr milliseconds kSettled{150};      // unchanged for so long, a file is taken for whole
constexpr milliseconds kShortestRest{20};  // between two looks at the folder
constexpr int kRestPerLook = 4;            // looking takes at most a fifth of the time
constexpr milliseconds kLater{1000};       // that files beside that of the points may come
constexpr milliseconds kPatience{5000};    // with a folder that cannot be read: its files may be half there

/// What tells that somebody has written to a file.
struct FileState {
  ::off_t bytes = 0;
  system_clock::time_point written_at;  ///< by the clock of the machine that has the disk, which may jump or be off

  bool operator==(const FileState&) const = default;
};

/// Nothing where the file is gone.
std::optional<FileState> state_of(const fs::path& file) {
  struct ::stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    return std::nullopt;
  }
  const auto since_epoch =
      std::chrono::seconds(status.st_mtim.tv_sec) + std::chrono::nanoseconds(status.st_mtim.tv_nsec);
  return FileState{status.st_size,
                   system_clock::time_point(std::chrono::duration_cast<system_clock::duration>(since_epoch))};
}

class FollowedFolder final : public FollowedDataset {
 public:
  FollowedFolder(fs::path folder, InputSettings settings) : folder_(std::move(folder)), settings_(std::move(settings)) {
    look();
  }

  bool wait_for(std::size_t index, const std::function<bool()>& stop) override {
    while (index >= complete_) {
      const steady_clock::time_point begun = steady_clock::now();
      look();
      if (index < complete_) {
        break;
      }
      const auto rest = std::max<steady_clock::duration>(kShortestRest, kRestPerLook * (steady_clock::now() - begun));
      for (const auto end = steady_clock::now() + rest; steady_clock::now() < end;) {
        if (stop()) {
          return false;
        }
        std::this_thread::sleep_for(kShortestRest);
      }
    }
    return true;
  }

  [[nodiscard]] std::optional<Arrival> arrival(std::size_t index) const override {
    const auto found = seen_.find(index);
    return found == seen_.end() ? std::nullopt : found->second.arrival;
  }

  void release_before(std::size_t index) override { seen_.erase(seen_.begin(), seen_.lower_bound(index)); }

  [[nodiscard]] std::string_view format() const override { return opened().format(); }
  [[nodiscard]] std::size_t size() const override { return complete_; }
  [[nodiscard]] Stamp stamp(std::size_t index) const override { return opened().stamp(index); }
  [[nodiscard]] fs::path scan_file(std::size_t index) const override { return opened().scan_file(index); }
  [[nodiscard]] RawScan scan(std::size_t index) const override {
    const steady_clock::time_point begun = steady_clock::now();
    while (true) {
      try {
        return opened().scan(index);
      } catch (const DataError&) {  // what lies beside it, such as the times of its points, may come later
        if (index + 1 < complete_ || steady_clock::now() - begun > kLater) {
          throw;
        }
      }
      std::this_thread::sleep_for(kShortestRest);
    }
  }
  [[nodiscard]] DopplerKind doppler_kind() const override { return opened().doppler_kind(); }
  [[nodiscard]] const formats::Trajectory& ground_truth() const override { return opened().ground_truth(); }
  [[nodiscard]] fs::path ground_truth_file() const override { return opened().ground_truth_file(); }
  [[nodiscard]] const std::vector<std::string>& assumptions() const override { return opened().assumptions(); }
  [[nodiscard]] std::optional<Eigen::Isometry3d> T_vehicle_sensor() const override {
    return opened().T_vehicle_sensor();
  }

 private:
  [[nodiscard]] const Dataset& opened() const {
    if (!dataset_) {
      throw DataError(fmt::format("{}: no scans yet", folder_.string()));
    }
    return *dataset_;
  }

  /// A file that was not known to be whole.
  struct Seen {
    FileState state;
    Arrival unchanged_since;
    std::optional<Arrival> arrival;  ///< nothing: as it was when the folder was first looked at
  };

  void look() {
    const Arrival now = steady_clock::now();
    look_at(now);
    looked_at_ = now;
  }

  /// Opens what is there now. What cannot be read may be half written: that is borne with for a while.
  void look_at(Arrival now) {
    std::unique_ptr<Dataset> next;
    try {
      next = open_input(folder_, settings_);
      fault_since_.reset();
    } catch (const NotARecording&) {
      if (dataset_ || !fs::is_directory(folder_)) {
        bear_with_fault();
      }
      return;
    } catch (const DataError&) {
      bear_with_fault();
      return;
    }
    note_changes(*next, now);
    check_unchanged(*next);
    const std::size_t complete = complete_of(*next, now);
    if (complete >= complete_ && complete > 0) {
      dataset_ = std::move(next);
      complete_ = complete;
    }
  }

  /// The clock of the machine says only when between two looks a file was written: it may have jumped.
  void note_changes(const Dataset& next, Arrival now) {
    const std::size_t last = next.size() - std::min<std::size_t>(next.size(), 1);
    for (std::size_t index = looked_at_ ? complete_ : last; index < next.size(); ++index) {
      const std::optional<FileState> state = state_of(next.scan_file(index));
      const auto known = seen_.find(index);
      if (!state) {
        seen_.erase(index);
      } else if (!looked_at_) {
        seen_[index] = {*state, now, std::nullopt};
      } else if (known == seen_.end() || known->second.state != *state) {
        const auto age = std::chrono::duration_cast<Arrival::duration>(system_clock::now() - state->written_at);
        const Arrival at = now - std::clamp(age, Arrival::duration::zero(), now - *looked_at_);
        seen_[index] = {*state, at, at};
      }
    }
  }

  /// Within a handler: throws again what has not gone away for long.
  void bear_with_fault() {
    const steady_clock::time_point now = steady_clock::now();
    fault_since_ = fault_since_.value_or(now);
    if (now - *fault_since_ >= kPatience || !fs::exists(folder_)) {
      throw;
    }
  }

  /// All but the last file, and that one when it has settled.
  [[nodiscard]] std::size_t complete_of(const Dataset& dataset, Arrival now) const {
    const std::size_t size = dataset.size();
    const auto last = size > 0 ? seen_.find(size - 1) : seen_.end();
    const bool is_known = size > 0 && size <= complete_;
    const bool has_settled = last != seen_.end() && now - last->second.unchanged_since >= kSettled;
    return is_known || has_settled ? size : size - std::min<std::size_t>(size, 1);
  }

  /// Scans that were read stay where they were.
  void check_unchanged(const Dataset& next) const {
    if (complete_ == 0) {
      return;
    }
    const std::size_t last = complete_ - 1;
    if (last >= next.size() || next.stamp(last) != dataset_->stamp(last) ||
        next.scan_file(last) != dataset_->scan_file(last)) {
      throw DataError(
          fmt::format("{}: was scan {}, and is no more: files must come in the order of their names, and stay",
                      dataset_->scan_file(last).string(), last));
    }
  }

  fs::path folder_;
  InputSettings settings_;
  std::optional<Arrival> looked_at_;  ///< when it was last
  std::map<std::size_t, Seen> seen_;  ///< by the index of the scan
  std::unique_ptr<Dataset> dataset_;  ///< as of the last look; null: nothing was there
  std::size_t complete_ = 0;
  std::optional<steady_clock::time_point> fault_since_;
};

}  // namespace

std::unique_ptr<FollowedDataset> follow_folder(const fs::path& folder, const InputSettings& settings) {
  return std::make_unique<FollowedFolder>(folder, settings);
}

}  // namespace dynamic_icp::datasets
