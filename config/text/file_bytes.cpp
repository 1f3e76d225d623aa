#include "config/text/file_bytes.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace clearance {
namespace {

// No mesh that describes a robot is nearly so large; an endless file ends here.
constexpr std::size_t kMaxFileBytes = std::size_t{256} << 20;

}  // namespace

int open_to_read(const std::filesystem::path& path) noexcept {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (file < 0) return file;
  struct stat status {};
  const bool is_known = ::fstat(file, &status) == 0;
  if (is_known && S_ISREG(status.st_mode)) return file;
  const int reason = !is_known ? errno : S_ISDIR(status.st_mode) ? EISDIR : EINVAL;
  ::close(file);
  errno = reason;
  return -1;
}

std::unique_ptr<std::FILE, CloseFile> open_file(const std::filesystem::path& path) noexcept {
  const int file = open_to_read(path);
  if (file < 0) return nullptr;
  std::unique_ptr<std::FILE, CloseFile> opened(::fdopen(file, "rb"));
  if (!opened) ::close(file);
  return opened;
}

std::variant<std::string, FileFault> read_bytes(const std::string& path) {
  const auto file = open_file(path);
  if (!file && errno == EISDIR) return FileFault{fmt::format("'{}' is a directory", path)};
  if (!file && errno == EINVAL) return FileFault{fmt::format("'{}' is no regular file", path)};
  if (!file) return FileFault{fmt::format("'{}' cannot be opened: {}", path, std::strerror(errno))};
  std::string bytes;
  std::array<char, 1 << 16> piece;
  while (const std::size_t count = std::fread(piece.data(), 1, piece.size(), file.get())) {
    bytes.append(piece.data(), count);
    if (bytes.size() > kMaxFileBytes)
      return FileFault{fmt::format("'{}' has more than {} MiB", path, kMaxFileBytes >> 20)};
  }
  if (std::ferror(file.get()) != 0)
    return FileFault{fmt::format("'{}' cannot be read: {}", path, std::strerror(errno))};
  return bytes;
}

bool write_bytes(int descriptor, std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace clearance
