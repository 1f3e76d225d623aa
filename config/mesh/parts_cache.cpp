#include "config/mesh/parts_cache.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "config/scene/revision.hpp"

namespace clearance {
namespace {

constexpr const char* kChecksum = "checksum ";

// 64 parts of 10,000 vertices need half as much.
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

// Root can change everything anyway.
bool belongs_to_user(const struct stat& status) {
  return status.st_uid == geteuid() || status.st_uid == 0;
}

bool is_own_folder(const std::filesystem::path& folder) {
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && belongs_to_user(status);
}

// Returns the content of a regular file of the user. Opening never waits, as it would for the
// writer of a FIFO.
std::optional<std::string> own_text(const std::filesystem::path& path) {
  const Descriptor file(
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW));
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) ||
      !belongs_to_user(status)) {
    return std::nullopt;
  }
  std::string text;
  std::array<char, 1 << 16> piece;
  for (;;) {
    const ssize_t count = ::read(file.number(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0 || text.size() > kMostBytes) return std::nullopt;
    if (count == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(count));
  }
}

bool write_new(const std::filesystem::path& path, std::string_view text) {
  ::unlink(path.c_str());
  const Descriptor file(
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644));
  if (file.number() < 0) return false;
  while (!text.empty()) {
    const ssize_t count = ::write(file.number(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

std::string checksum(const std::string& text) {
  Revision hash;
  hash.add(text);
  return fmt::format("{:016x}", hash.value());
}

std::string text_of(const std::string& key, const ConvexParts& parts) {
  std::string text = fmt::format("clearance parts\nkey {}\nerror {:a}\nparts {}\n", key,
                                 parts.error, parts.parts.size());
  for (const auto& part : parts.parts) {
    text += fmt::format("part {}\n", part.size());
    for (const Vec3& v : part) text += fmt::format("{:a} {:a} {:a}\n", v.x(), v.y(), v.z());
  }
  return text + kChecksum + checksum(text) + "\n";
}

// Reads the text word by word. A text whose checksum is correct is hardly ever malformed, but even
// then it must not crash the reader.
class PartsText {
 public:
  explicit PartsText(const std::string& text) : words_(text) {}

  bool says(const std::string& expected) {
    std::string word;
    return static_cast<bool>(words_ >> word) && word == expected;
  }
  double number() {
    std::string word;
    if (!(words_ >> word)) return std::nan("");
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    return end == word.c_str() + word.size() ? number : std::nan("");
  }

 private:
  std::istringstream words_;
};

std::optional<ConvexParts> parts_of(const std::string& text, const std::string& key) {
  const std::size_t end = text.rfind(kChecksum);
  if (end == std::string::npos ||
      text.substr(end) != kChecksum + checksum(text.substr(0, end)) + "\n") {
    return std::nullopt;
  }
  PartsText words(text);
  if (!words.says("clearance") || !words.says("parts") || !words.says("key") || !words.says(key) ||
      !words.says("error")) {
    return std::nullopt;
  }
  ConvexParts parts;
  parts.error = words.number();
  if (!(parts.error >= 0.0 && std::isfinite(parts.error))) return std::nullopt;
  if (!words.says("parts")) return std::nullopt;
  const double count = words.number();
  for (double i = 0.0; i < count; ++i) {
    if (!words.says("part")) return std::nullopt;
    parts.parts.emplace_back();
    const double vertices = words.number();
    for (double k = 0.0; k < vertices; ++k) {
      Vec3 vertex;
      for (double& x : vertex) x = words.number();
      if (!vertex.allFinite()) return std::nullopt;
      parts.parts.back().push_back(vertex);
    }
  }
  return parts.parts.empty() ? std::nullopt : std::optional(std::move(parts));
}

// Several programs may read a new cell at once: each writes a file of its own and renames it.
bool write_whole(const std::filesystem::path& file, const std::string& text) {
  std::error_code fault;
  std::filesystem::create_directories(file.parent_path(), fault);
  if (!is_own_folder(file.parent_path())) return false;
  std::filesystem::path own = file;
  own += fmt::format(".{}", getpid());
  const bool written = write_new(own, text);
  if (written) std::filesystem::rename(own, file, fault);
  if (written && !fault) return true;
  std::filesystem::remove(own, fault);
  return false;
}

}  // namespace

PartsCache::PartsCache(const std::optional<std::filesystem::path>& beside) {
  if (beside) folders_.push_back(*beside / "clearance.parts");
  const char* const cache = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (cache != nullptr && *cache == '/') {
    folders_.push_back(std::filesystem::path(cache) / "clearance" / "parts");
  } else if (home != nullptr && *home == '/') {
    folders_.push_back(std::filesystem::path(home) / ".cache" / "clearance" / "parts");
  }
}

std::optional<ConvexParts> PartsCache::find(const std::string& key) const {
  for (const std::filesystem::path& folder : folders_) {
    if (!is_own_folder(folder)) continue;
    const auto text = own_text(folder / (key + ".parts"));
    if (!text) continue;
    if (auto parts = parts_of(*text, key)) return parts;
  }
  return std::nullopt;
}

std::filesystem::path PartsCache::keep(const std::string& key, const ConvexParts& parts) const {
  const std::string text = text_of(key, parts);
  for (const std::filesystem::path& folder : folders_) {
    if (write_whole(folder / (key + ".parts"), text)) return folder;
  }
  return {};
}

}  // namespace clearance
