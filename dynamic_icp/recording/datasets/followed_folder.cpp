// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/datasets/followed_folder.hpp"

#include <algorithm>
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

constexpr milliseconds kSettled{150};      // since the last byte of a file that is taken for whole
constexpr milliseconds kShortestRest{20};  // between two looks at the folder
constexpr int kRestPerLook = 4;            // looking takes at most a fifth of the time
constexpr milliseconds kLater{1000};       // that files beside that of the points may come
constexpr milliseconds kPatience{5000};    // with a folder that cannot be read: its files may be half there

/// When a file was last written to; nothing where it is gone.
std::optional<Arrival> written_at(const fs::path& file) {
  struct ::stat status {};
  if (::stat(file.c_str(), &status) != 0) {
    return std::nullopt;
  }
  return Arrival(std::chrono::duration_cast<system_clock::duration>(std::chrono::seconds(status.st_mtim.tv_sec) +
                                                                    std::chrono::nanoseconds(status.st_mtim.tv_nsec)));
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
    const std::optional<Arrival> written = written_at(scan_file(index));
    return written && *written > followed_since_ ? written : std::nullopt;
  }

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

  /// Opens what is there now. What cannot be read may be half written: that is borne with for a while.
  void look() {
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
    const std::size_t complete = complete_of(*next);
    check_unchanged(*next);
    if (complete >= complete_ && complete > 0) {
      dataset_ = std::move(next);
      complete_ = complete;
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

  static std::size_t complete_of(const Dataset& dataset) {
    const std::size_t size = dataset.size();
    const std::optional<Arrival> last = size > 0 ? written_at(dataset.scan_file(size - 1)) : std::nullopt;
    return last && system_clock::now() - *last >= kSettled ? size : size - std::min<std::size_t>(size, 1);
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
  Arrival followed_since_ = system_clock::now();
  std::unique_ptr<Dataset> dataset_;  ///< as of the last look; null: nothing was there
  std::size_t complete_ = 0;
  std::optional<steady_clock::time_point> fault_since_;
};

}  // namespace

std::unique_ptr<FollowedDataset> follow_folder(const fs::path& folder, const InputSettings& settings) {
  return std::make_unique<FollowedFolder>(folder, settings);
}

}  // namespace dynamic_icp::datasets
