// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

namespace dynamic_icp::python {

/// Throws what a signal asks for, KeyboardInterrupt for Ctrl-C. To be called now and then where the GIL is released.
void raise_interrupts();

}  // namespace dynamic_icp::python
