// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace dynamic_icp {

/// The known key that was probably meant by what was typed: one of which that is a part of three letters or more
/// ("voxel"), else the one with the fewest letters to change, where two neighbours in each other's place are one change
/// and the last part of a dotted key ("voxel_size_m") counts as the whole; the first of equals. Capital letters are no
/// change. Empty when there are no keys.
std::string_view nearest_key(std::string_view typed, std::span<const std::string> keys);

/// The same where it may well be a slip of the typist: no more than a third of its letters, rounded up, are to change.
/// Empty otherwise: a word that is far from all keys was meant otherwise.
std::string_view close_key(std::string_view typed, std::span<const std::string> keys);

/// " (did you mean 'KEY'?)" for such a key, to go into a message; "" without one.
std::string did_you_mean(std::string_view typed, std::span<const std::string> keys);

}  // namespace dynamic_icp
