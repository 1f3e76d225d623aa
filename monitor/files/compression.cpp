// Both decompress as streams, so that a chunk that is cut off still gives its first records.
#include "monitor/files/compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace clearance {
namespace {

// A damaged file may state any size, so memory grows block by block.
constexpr std::size_t kPiece = std::size_t{1} << 22;

// Reports of one cell resemble each other so much that higher levels gain little.
constexpr int kZstdLevel = 1;

// Calls `step(out)`, which returns how many bytes it wrote there, until it writes none or `size`
// bytes are out.
template <class Step>
void grow(std::size_t size, std::vector<std::byte>& out, const Step& step) {
  out.clear();
  std::size_t written = 0;
  while (written < size) {
    if (written == out.size()) out.resize(std::min(size, written + kPiece));
    const std::size_t more = step(std::span(out).subspan(written));
    written += more;
    if (more == 0) break;
  }
  out.resize(written);
}

void decompress_zstd(std::span<const std::byte> compressed, std::size_t size,
                     std::vector<std::byte>& out) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(),
                                                                     &ZSTD_freeDCtx);
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  bool failed = context == nullptr;
  grow(size, out, [&](std::span<std::byte> room) {
    ZSTD_outBuffer to{room.data(), room.size(), 0};
    while (!failed && to.pos == 0) {
      const std::size_t before = in.pos;
      failed = ZSTD_isError(ZSTD_decompressStream(context.get(), &to, &in)) != 0 ||
               (to.pos == 0 && in.pos == before);
    }
    return to.pos;
  });
}

void decompress_lz4(std::span<const std::byte> compressed, std::size_t size,
                    std::vector<std::byte>& out) {
  LZ4F_dctx* made = nullptr;
  bool failed = LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  grow(size, out, [&](std::span<std::byte> room) {
    std::size_t written = 0;
    while (!failed && written == 0) {
      std::size_t read = compressed.size();
      written = room.size();
      failed = LZ4F_isError(LZ4F_decompress(context.get(), room.data(), &written, compressed.data(),
                                            &read, nullptr)) != 0;
      if (failed) written = 0;
      failed = failed || (written == 0 && read == 0);
      compressed = compressed.subspan(read);
    }
    return written;
  });
}

}  // namespace

std::optional<McapCompression> mcap_compression(std::string_view name) noexcept {
  if (name.empty()) return McapCompression::kStored;
  if (name == "zstd") return McapCompression::kZstd;
  if (name == "lz4") return McapCompression::kLz4;
  return std::nullopt;
}

std::string_view name(McapCompression compression) noexcept {
  switch (compression) {
    case McapCompression::kStored:
      return "";
    case McapCompression::kZstd:
      return "zstd";
    case McapCompression::kLz4:
      return "lz4";
  }
  return "";
}

void decompress(McapCompression compression, std::span<const std::byte> compressed,
                std::size_t size, std::vector<std::byte>& out) {
  if (compression == McapCompression::kZstd) return decompress_zstd(compressed, size, out);
  if (compression == McapCompression::kLz4) return decompress_lz4(compressed, size, out);
  const auto bytes = compressed.first(std::min(size, compressed.size()));
  out.assign(bytes.begin(), bytes.end());
}

void compress_zstd(std::span<const std::byte> bytes, std::vector<std::byte>& out) {
  out.resize(ZSTD_compressBound(bytes.size()));
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  out.resize(ZSTD_isError(size) != 0 ? 0 : size);
}

}  // namespace clearance
