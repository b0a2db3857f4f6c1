// Copyright (c) 2026 The Dynamic-ICP developers
// SPDX-License-Identifier: MIT
#include "dynamic_icp/recording/bags/compression.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <span>

#include <bzlib.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <unistd.h>
#include <zstd.h>

#include "dynamic_icp/method/base/error.hpp"
#include "dynamic_icp/recording/bags/byte_source.hpp"

namespace dynamic_icp::bags {
namespace {

/// What one call of a decoder did.
struct Step {
  std::size_t consumed = 0;
  std::size_t produced = 0;
  bool is_end = false;  ///< of a frame; another may follow
  std::string fault;
};

class Decoder {
 public:
  Decoder() = default;
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;
  virtual Step decode(std::string_view in, std::span<char> out) = 0;
};

class Bz2Decoder final : public Decoder {
 public:
  Bz2Decoder() { begin(); }
  ~Bz2Decoder() override { BZ2_bzDecompressEnd(&stream_); }

  Step decode(std::string_view in, std::span<char> out) override {
    const std::size_t most = std::numeric_limits<unsigned>::max();
    const std::size_t in_size = std::min(in.size(), most);
    const std::size_t out_size = std::min(out.size(), most);
    stream_.next_in = const_cast<char*>(in.data());  // read only, says the library's manual
    stream_.avail_in = static_cast<unsigned>(in_size);
    stream_.next_out = out.data();
    stream_.avail_out = static_cast<unsigned>(out_size);
    const int code = BZ2_bzDecompress(&stream_);
    Step step{in_size - stream_.avail_in, out_size - stream_.avail_out, code == BZ_STREAM_END, {}};
    if (code == BZ_MEM_ERROR) {
      throw std::bad_alloc();
    }
    if (code != BZ_OK && code != BZ_STREAM_END) {
      step.fault = code == BZ_DATA_ERROR_MAGIC ? "is not packed with bzip2" : "the bzip2 data are damaged";
    }
    if (step.is_end) {
      BZ2_bzDecompressEnd(&stream_);
      begin();
    }
    return step;
  }

 private:
  void begin() {
    stream_ = bz_stream{};
    if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) {
      throw std::bad_alloc();
    }
  }

  bz_stream stream_{};
};

class Lz4Decoder final : public Decoder {
 public:
  Lz4Decoder() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION)) != 0) {
      throw std::bad_alloc();
    }
  }
  ~Lz4Decoder() override { LZ4F_freeDecompressionContext(context_); }

  Step decode(std::string_view in, std::span<char> out) override {
    Step step{in.size(), out.size(), false, {}};
    const std::size_t hint = LZ4F_decompress(context_, out.data(), &step.produced, in.data(), &step.consumed, nullptr);
    if (LZ4F_isError(hint) != 0) {
      step = {0, 0, false, fmt::format("the LZ4 data are damaged ({})", LZ4F_getErrorName(hint))};
    }
    step.is_end = hint == 0;
    return step;
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class ZstdDecoder final : public Decoder {
 public:
  ZstdDecoder() : context_(ZSTD_createDCtx()) {
    if (context_ == nullptr) {
      throw std::bad_alloc();
    }
  }
  ~ZstdDecoder() override { ZSTD_freeDCtx(context_); }

  Step decode(std::string_view in, std::span<char> out) override {
    ZSTD_inBuffer from{in.data(), in.size(), 0};
    ZSTD_outBuffer to{out.data(), out.size(), 0};
    const std::size_t hint = ZSTD_decompressStream(context_, &to, &from);
    if (ZSTD_isError(hint) != 0) {
      return {from.pos, to.pos, false, fmt::format("the Zstandard data are damaged ({})", ZSTD_getErrorName(hint))};
    }
    return {from.pos, to.pos, hint == 0, {}};
  }

 private:
  ZSTD_DCtx* context_;
};

std::unique_ptr<Decoder> decoder_of(Compression compression) {
  switch (compression) {
    case Compression::kBz2:
      return std::make_unique<Bz2Decoder>();
    case Compression::kLz4:
      return std::make_unique<Lz4Decoder>();
    default:
      return std::make_unique<ZstdDecoder>();
  }
}

/// Unpacks until the input ends or more than `max_bytes` come out; memory grows with what comes out.
Unpacked pump(Decoder& decoder, std::string_view packed, std::uint64_t max_bytes) {
  constexpr std::size_t kFirst = std::size_t{1} << 16U;
  Unpacked result;
  std::string& bytes = result.bytes;
  std::size_t used = 0;
  bool is_end = false;
  // One byte more than may come out, to see that nothing follows.
  const std::uint64_t room = std::min(max_bytes, kMaxPieceBytes) + 1;
  while (!packed.empty() || !is_end) {
    if (used == bytes.size()) {
      const std::uint64_t wanted = std::max<std::uint64_t>({kFirst, 2 * packed.size(), 2 * bytes.size()});
      bytes.resize(std::min(wanted, room));
    }
    const Step step = decoder.decode(packed, std::span(bytes).subspan(used));
    packed.remove_prefix(step.consumed);
    used += step.produced;
    is_end = step.is_end;
    if (used == room) {
      --used;
      result.fault = fmt::format("more than {} bytes come out", used);
      break;
    }
    if (!step.fault.empty()) {
      result.fault = step.fault;
      break;
    }
    if (step.consumed == 0 && step.produced == 0 && !is_end) {
      result.is_cut = packed.empty();
      result.fault = result.is_cut ? "the packed data are cut short" : "the packed data are damaged";
      break;
    }
  }
  bytes.resize(used);
  return result;
}

}  // namespace

std::optional<Compression> compression_of(std::string_view name) {
  if (name.empty() || name == "none") {
    return Compression::kNone;
  }
  if (name == "bz2") {
    return Compression::kBz2;
  }
  if (name == "lz4") {
    return Compression::kLz4;
  }
  return name == "zstd" ? std::optional(Compression::kZstd) : std::nullopt;
}

Unpacked unpack(Compression compression, std::string_view packed, std::uint64_t size) {
  Unpacked result;
  if (compression == Compression::kNone) {
    result.bytes = packed.substr(0, size);
  } else if (!packed.empty()) {
    result = pump(*decoder_of(compression), packed, size);
  }
  if (result.fault.empty() &&
      (result.bytes.size() != size || (compression == Compression::kNone && packed.size() != size))) {
    result.fault = fmt::format("holds {} bytes, expected {}",
                               compression == Compression::kNone ? packed.size() : result.bytes.size(), size);
    result.is_cut = compression == Compression::kNone && packed.size() < size;
  }
  return result;
}

Unpacked unpack_zstd(std::string_view packed, std::uint64_t max_bytes) {
  ZstdDecoder decoder;
  return pump(decoder, packed, max_bytes);
}

namespace {

/// Passes what comes out of a packed file on until `take` says that it is enough; where it is cut short, says so.
/// Throws DataError where it is damaged.
std::string stream_zstd_file(const std::filesystem::path& packed, const std::function<bool(std::string_view)>& take) {
  const ReadableFile file(packed);
  ZstdDecoder decoder;
  std::string out(ZSTD_DStreamOutSize(), '\0');
  bool is_end = false;
  for (std::uint64_t at = 0; at < file.size();) {
    const std::string piece = file.read(at, std::min<std::uint64_t>(ZSTD_DStreamInSize(), file.size() - at));
    at += piece.size();
    std::string_view rest = piece;
    bool is_full = false;  // more may come out without more going in
    while (!rest.empty() || is_full) {
      const Step step = decoder.decode(rest, out);
      rest.remove_prefix(step.consumed);
      is_full = step.produced == out.size() && !step.is_end;
      is_end = step.is_end;
      if (step.produced > 0 && !take(std::string_view(out).substr(0, step.produced))) {
        return {};
      }
      if (!step.fault.empty()) {
        throw DataError(fmt::format("{}: {} before byte {}", packed.string(), step.fault, at));
      }
    }
  }
  return is_end ? std::string() : fmt::format("the packed data are cut short at byte {}", file.size());
}

}  // namespace

std::string zstd_file_head(const std::filesystem::path& packed, std::size_t count) {
  std::string head;
  try {
    stream_zstd_file(packed, [&](std::string_view bytes) {
      head += bytes.substr(0, count - head.size());
      return head.size() < count;
    });
  } catch (const DataError&) {  // what came before tells what it is
  }
  return head;
}

std::string unpack_zstd_file(const std::filesystem::path& packed, const std::filesystem::path& unpacked) {
  const int descriptor = ::open(unpacked.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const auto fail = [&](const char* action) {
    return DataError(fmt::format("{}: cannot {} to unpack {}: {}", unpacked.string(), action, packed.string(),
                                 std::strerror(errno)));
  };
  if (descriptor < 0) {
    throw fail("create");
  }
  struct Closer {
    int descriptor;
    ~Closer() { ::close(descriptor); }
  } const closer{descriptor};
  return stream_zstd_file(packed, [&](std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t done = ::write(descriptor, bytes.data(), bytes.size());
      if (done < 0 && errno != EINTR) {
        throw fail("write");
      }
      bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(done, 0)));
    }
    return true;
  });
}

}  // namespace dynamic_icp::bags
