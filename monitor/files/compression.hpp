// Compression of chunks of records: zstd or LZ4 frames, as the MCAP specification names them. Both
// libraries check their own checksums, where the file has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace clearance {

enum class McapCompression : std::uint8_t { kStored, kZstd, kLz4 };

// "", "zstd", "lz4"; nothing: another one.
[[nodiscard]] std::optional<McapCompression> mcap_compression(std::string_view name) noexcept;
[[nodiscard]] std::string_view name(McapCompression compression) noexcept;

// Decompresses bytes of any origin into `out`: at most `size` bytes, fewer where they end early or
// are not valid.
void decompress(McapCompression compression, std::span<const std::byte> compressed,
                std::size_t size, std::vector<std::byte>& out);

// Compresses into one zstd frame that states its size. This is fast, and shrinks our reports to
// between a third and a tenth of their size. The same bytes and library give the same frame. Empty
// when there is no memory for it.
void compress_zstd(std::span<const std::byte> bytes, std::vector<std::byte>& out);

}  // namespace clearance
