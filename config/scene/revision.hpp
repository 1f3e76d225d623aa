// The files of a scene: where they are, and their 64-bit FNV-1a hash, by which two scenes are told
// apart. It detects mistakes, not attacks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

namespace clearance {

// `name` as it is written in a file that stands in `base`. Under a `root`, which is not empty,
// stand the files of another machine, as they did there: absolute paths lead there as well, and
// those that do already stay as they are.
[[nodiscard]] inline std::filesystem::path path_in(const std::filesystem::path& root,
                                                   const std::filesystem::path& base,
                                                   const std::filesystem::path& name) {
  if (root.empty() || !name.is_absolute()) return base / name;
  const bool is_there = std::ranges::mismatch(root, name).in1 == root.end();
  return is_there ? name : root / name.relative_path();
}

class Revision {
 public:
  // As of path_in().
  explicit Revision(std::filesystem::path root = {}) : root_(std::move(root)) {}
  [[nodiscard]] const std::filesystem::path& root() const noexcept { return root_; }

  void add(std::string_view bytes) noexcept {
    for (const char byte : bytes) {
      hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
    }
  }

  // A file's bytes; its path is kept.
  void add_file(const std::filesystem::path& path, std::string_view bytes) {
    add(bytes);
    const auto absolute = std::filesystem::absolute(path).lexically_normal();
    if (std::ranges::find(files_, absolute) == files_.end()) files_.push_back(absolute);
  }
  // Absolute; each once, in order.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept { return files_; }

  // Never 0: on the wire that means "not checked".
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_ == 0 ? 1 : hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
  std::filesystem::path root_;
  std::vector<std::filesystem::path> files_;
};

}  // namespace clearance
