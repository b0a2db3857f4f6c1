// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "dynamic_icp/recording/formats/result_kind.hpp"

// How a whole folder takes the place of another one, for output_folder.hpp. Whatever ends the process on the way,
// remove_leftovers() of the next one brings either result into place.
namespace dynamic_icp::formats {

/// Throws when what is in this folder may not be replaced.
using FolderCheck = std::function<void(const std::filesystem::path& folder)>;

/// Nothing is in it but temporary folders of ours.
bool is_vacant(const std::filesystem::path& folder);

/// Whether another folder cannot be renamed to this one: it is a mount point, the working directory, or lies where
/// nothing can be made.
bool must_stay(const std::filesystem::path& folder);

/// Renames the partial folder of that number beside `target` to it. `target` is not there, is vacant, or holds what
/// `check` lets go: once before anything is moved, and once more when nobody can come to it any more.
void move_beside(const std::filesystem::path& target, const std::string& number, const FolderCheck& check);

/// The same for a `target` to be replaced, and that is locked, where the file system cannot exchange two folders.
void replace_in_two_steps(const std::filesystem::path& target, const std::string& number, const FolderCheck& check);

/// Moves what is in the partial folder of that number within `target` up into it. The file `marker` goes first and
/// comes last.
void move_within(const std::filesystem::path& target, const std::string& number, const std::string& marker,
                 const FolderCheck& check);

/// Whether a partial folder can be gone on with.
bool has_checkpoint(const std::filesystem::path& folder, const ResultKind& kind);

/// Ends what killed processes have left beside and within the folder of a result; what a running one holds stays.
void remove_leftovers(const std::filesystem::path& target);

/// Removes what killed processes have left of other results of this kind in a folder: partial folders that nobody
/// holds, in which every file is one of such a result, and none a checkpoint. Nothing else is ever removed.
void remove_abandoned(const std::filesystem::path& folder, const ResultKind& kind);

}  // namespace dynamic_icp::formats
