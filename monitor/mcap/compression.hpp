// What a chunk of records may be compressed with: zstd or LZ4 frames, as the MCAP specification
// names them. Both libraries check their own checksums, where the file has them.
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

// Decompresses bytes of any origin into `out`: at most `size` bytes, fewer where they end before or
// make no sense.
void decompress(McapCompression compression, std::span<const std::byte> compressed,
                std::size_t size, std::vector<std::byte>& out);

// As one zstd frame that states its size: fast, a third to a tenth of the size of our reports. The
// same bytes and library give the same frame. Empty when there is no memory for it.
void compress_zstd(std::span<const std::byte> bytes, std::vector<std::byte>& out);

}  // namespace clearance
