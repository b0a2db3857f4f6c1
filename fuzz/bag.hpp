// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/bag.hpp"

#include "fuzz/memory_file.hpp"

namespace dynamic_icp::fuzz {

/// Reads all that a file holds, whatever kind of bag it is; a DataError is right for any bytes.
inline void read_bag(const std::filesystem::path& path) {
  try {
    const std::unique_ptr<bags::Bag> bag = bags::open_bag(path);
    std::vector<std::size_t> topics(bag->topics().size());
    std::iota(topics.begin(), topics.end(), std::size_t{0});
    std::int64_t before = 0;
    for (const bags::MessageEntry& entry : bag->messages(topics)) {
      must(entry.topic < topics.size());
      must(entry.recorded_ns >= before || before == 0);
      before = entry.recorded_ns;
      try {
        const std::string whole = bag->read(entry);
        must(whole.starts_with(bag->read_front(entry, 8).substr(0, 8)));
      } catch (const DataError&) {  // the next message may be whole
      }
    }
  } catch (const DataError&) {
  }
}

}  // namespace dynamic_icp::fuzz
