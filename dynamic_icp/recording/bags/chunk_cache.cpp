// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/chunk_cache.hpp"

#include <algorithm>

namespace dynamic_icp::bags {

ChunkCache::Content ChunkCache::get(std::uint64_t place, const std::function<std::string()>& unpack) {
  std::promise<Content> promise;
  std::shared_future<Content> kept;
  {
    const std::lock_guard lock(mutex_);
    const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.place == place; });
    if (found != kept_.end()) {
      kept_.splice(kept_.begin(), kept_, found);
      kept = found->content;
    } else {
      kept_.push_front({place, promise.get_future().share(), 0});
    }
  }
  if (kept.valid()) {
    return kept.get();
  }
  try {
    auto content = std::make_shared<const std::string>(unpack());
    promise.set_value(content);
    finish(place, content->size());
    return content;
  } catch (...) {
    promise.set_exception(std::current_exception());
    forget(place);
    throw;
  }
}

void ChunkCache::finish(std::uint64_t place, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  std::size_t sum = 0;
  for (auto kept = kept_.begin(); kept != kept_.end();) {
    if (kept->place == place) {
      kept->bytes = bytes;
    }
    sum += kept->bytes;
    const bool is_too_much = kept != kept_.begin() && kept->bytes > 0 && sum > max_bytes_;
    kept = is_too_much ? kept_.erase(kept) : std::next(kept);
  }
}

void ChunkCache::forget(std::uint64_t place) {
  const std::lock_guard lock(mutex_);
  kept_.remove_if([&](const Kept& k) { return k.place == place; });
}

}  // namespace dynamic_icp::bags
