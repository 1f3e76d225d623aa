#include "config/text/file_bytes.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace clearance {
namespace {

// No mesh that describes a robot is nearly so large; an endless file ends here.
constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20;

}  // namespace

std::variant<std::string, FileFault> read_bytes(const std::string& path) {
  std::error_code fault;
  if (std::filesystem::is_directory(path, fault))
    return FileFault{fmt::format("'{}' is a directory", path)};
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return FileFault{fmt::format("'{}' cannot be opened: {}", path, std::strerror(errno))};
  std::string bytes;
  std::array<char, 1 << 16> piece;
  while (stream.read(piece.data(), piece.size()) || stream.gcount() > 0) {
    bytes.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    if (bytes.size() > kMaxFileBytes) {
      return FileFault{fmt::format("'{}' has more than {} MiB", path, kMaxFileBytes >> 20)};
    }
  }
  if (stream.bad())
    return FileFault{fmt::format("'{}' cannot be read: {}", path, std::strerror(errno))};
  return bytes;
}

}  // namespace clearance
