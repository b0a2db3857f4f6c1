// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/formats/npz.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "dynamic_icp/method/base/error.hpp"

#include "fuzz/memory_file.hpp"

// Any bytes are read, and written again as the same, or refused with a DataError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dynamic_icp;
  try {
    const fuzz::MemoryFile input(data, size);
    const formats::NpzFile file(input.path());
    std::vector<formats::NpzMember> members;
    for (const std::string& name : file.names()) {
      if (file.why_no_numbers(name).empty()) {
        members.push_back({name, file.read(name)});
      }
    }
    const std::string bytes = formats::npz_bytes(members);
    const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    const formats::NpzFile again(written.path());
    for (const formats::NpzMember& member : members) {
      fuzz::must(again.contains(member.name) && again.read(member.name).bytes == member.array.bytes);
    }
  } catch (const DataError&) {
  } catch (const std::invalid_argument&) {  // no arrays, or names that an archive cannot have
  }
  return 0;
}
