// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace dynamic_icp::benchmark {

/// What times depend on: the processor and the number of processors.
std::string describe_processor();

/// The processor, memory and operating system in words.
std::string describe_machine();

/// Memory that can still be had without swapping, MiB; empty where the system does not tell.
std::optional<double> available_memory_mib();

}  // namespace dynamic_icp::benchmark
