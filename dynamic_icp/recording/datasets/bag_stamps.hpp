// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/stamp.hpp"

namespace dynamic_icp::datasets {

/// The messages of a topic that are kept, and when they are.
struct ChosenStamps {
  std::vector<std::size_t> kept;         ///< numbers of the messages, ascending
  std::vector<Stamp> stamps;             ///< as long, strictly increasing
  bool are_recorded = false;             ///< the times at which messages were recorded, not those of their headers
  std::vector<std::string> assumptions;  ///< sentences for the user
};

/// Whether a header is at most an hour away from the time of recording.
bool is_sane(Stamp header, std::int64_t recorded_ns);

/// Decides between the stamps in the headers of messages and the times at which they were recorded. `headers` and
/// `recorded_ns` are as long as each other, in the order of recording; `topic` is named in sentences.
///
/// A header is sane when it is at most an hour away from the time of recording, which a 0 is in simulated time only.
/// Where most are, headers are taken and the other messages left out; else the times of recording. Of what is not in
/// order as few as possible are left out, which is said: a stamp from the far future costs one message, not all that
/// follow.
ChosenStamps choose_stamps(std::span<const std::int64_t> recorded_ns, std::span<const Stamp> headers,
                           const std::string& topic);

/// The same by the times of recording.
ChosenStamps recorded_stamps(std::span<const std::int64_t> recorded_ns, const std::string& topic);

/// The numbers of the longest strictly increasing sequence among some stamps, ascending.
std::vector<std::size_t> longest_increasing(std::span<const Stamp> stamps);

}  // namespace dynamic_icp::datasets
