// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/live/low_priority.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

namespace dynamic_icp::live {

void lower_own_priority() {
#ifdef __linux__
  constexpr int kLow = 10;  // of `nice`; Linux keeps it for each thread
  static_cast<void>(::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLow));
#endif
}

void name_own_thread(const char* name) {
#ifdef __linux__
  static_cast<void>(::pthread_setname_np(::pthread_self(), name));
#endif
}

}  // namespace dynamic_icp::live
