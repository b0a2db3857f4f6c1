// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/tools/report/zlib_stream.hpp"

#include <stdexcept>

#include <zlib.h>

namespace dynamic_icp::report {

std::string zlib_stream(std::string_view bytes) {
  constexpr int kLevel = 6;  // higher ones take several times as long for 1 % less
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string stream(size, '\0');
  const int status = compress2(reinterpret_cast<Bytef*>(stream.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), kLevel);
  if (status != Z_OK) {
    throw std::runtime_error("the data of the page could not be compressed: no memory left");
  }
  stream.resize(size);
  return stream;
}

}  // namespace dynamic_icp::report
