#include "config/mesh/parts_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>

#include "config/scene/revision.hpp"

namespace clearance {
namespace {

constexpr const char* kChecksum = "checksum ";

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
  std::filesystem::path own = file;
  own += fmt::format(".{}", getpid());
  std::ofstream stream(own, std::ios::binary);
  stream << text;
  stream.close();
  if (stream) std::filesystem::rename(own, file, fault);
  if (stream && !fault) return true;
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
    std::ifstream stream(folder / (key + ".parts"), std::ios::binary);
    if (!stream) continue;
    std::ostringstream text;
    text << stream.rdbuf();
    if (auto parts = parts_of(text.str(), key)) return parts;
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
