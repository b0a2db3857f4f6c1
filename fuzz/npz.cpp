// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npz.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"

#include "fuzz/memory_file.hpp"

namespace {

using namespace dynamic_icp;

/// Arrays that are read, each by itself. What is known to hold no numbers, or is not there, must be refused.
std::vector<formats::NpzMember> members_of(const formats::NpzFile& file) {
  std::vector<std::string> names = file.names();
  names.emplace_back("array that nobody has");
  std::vector<formats::NpzMember> members;
  for (const std::string& name : names) {
    try {
      members.push_back({name, file.read(name)});
      fuzz::must(file.contains(name) && file.why_no_numbers(name).empty());
    } catch (const DataError&) {  // the next one may be whole
    }
  }
  return members;
}

/// What was written is read: a DataError is a finding here, too.
void must_hold(const std::filesystem::path& path, const std::vector<formats::NpzMember>& members) try {
  const formats::NpzFile file(path);
  for (const formats::NpzMember& member : members) {
    fuzz::must(file.contains(member.name) && file.read(member.name).bytes == member.array.bytes);
  }
} catch (const DataError&) {
  fuzz::must(false);
}

}  // namespace

// Any bytes are read, and written again as the same, or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const fuzz::MemoryFile input(data, size);
    const std::vector<formats::NpzMember> members = members_of(formats::NpzFile(input.path()));
    const std::filesystem::path written = input.path().parent_path() / "written.npz";
    formats::write_npz(written, members);
    must_hold(written, members);
  } catch (const DataError&) {
  } catch (const std::invalid_argument&) {  // no arrays, or names that an archive cannot have
  }
  return 0;
}
