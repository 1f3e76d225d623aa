// The only file that includes zlib, whose crc32_z takes lengths over 4 GiB.
#include "monitor/files/format.hpp"

#include <zlib.h>

namespace clearance {

std::uint32_t mcap_crc(std::uint32_t crc, std::span<const std::byte> bytes) noexcept {
  return static_cast<std::uint32_t>(
      crc32_z(crc, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

}  // namespace clearance
