// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp {

/// Lets the process keep the memory it frees. A scan asks for as much as the one before; to get it from the system
/// anew, page by page, costs more than to fill it. For a program, once, at its start: it is no business of a library.
/// Does nothing where the C library has no such switch.
void keep_freed_memory();

}  // namespace dynamic_icp
