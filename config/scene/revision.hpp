// The files of a cell: their paths, and two hashes of all that was read. The revision, 64-bit
// FNV-1a, distinguishes two scenes in each message; it detects mistakes, not attacks. SHA-256
// detects both.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "config/text/file_bytes.hpp"
#include "config/text/fnv1a.hpp"
#include "config/text/sha256.hpp"

namespace clearance {

// Returns the path of a file that is called `name` by a file in the folder `base`. A `root` holds a
// copy of another machine's files, at the paths that they have there. With a root, absolute names
// are taken relative to it, unless they are in it already.
[[nodiscard]] inline std::filesystem::path path_in(const std::filesystem::path& root,
                                                   const std::filesystem::path& base,
                                                   const std::filesystem::path& name) {
  if (root.empty() || !name.is_absolute()) return base / name;
  const bool is_there = std::ranges::mismatch(root, name).in1 == root.end();
  return is_there ? name : root / name.relative_path();
}

// True if a path leads out of the root, as root/../x does. Nothing leads out of an empty root.
[[nodiscard]] inline bool leads_out_of(const std::filesystem::path& root,
                                       const std::filesystem::path& path) {
  if (root.empty()) return false;
  const auto outer = std::filesystem::absolute(root).lexically_normal();
  const auto inner = std::filesystem::absolute(path).lexically_normal();
  return std::ranges::mismatch(outer, inner).in1 != outer.end();
}

// Ends a sentence that begins with the name of a file for which leads_out_of() is true.
inline constexpr std::string_view kLeadsOut = "leads out of the files that are kept with the cell";

// Asked before a file that a cell names is touched. Returns why it may not be read, as a FileFault
// does; nothing: it may.
using MayRead = std::function<std::optional<std::string>(const std::filesystem::path&)>;

class Revision {
 public:
  // `root` as in path_in(). Without `may_read`, every file may be read.
  explicit Revision(std::filesystem::path root = {}, MayRead may_read = {})
      : root_(std::move(root)), may_read_(std::move(may_read)) {}
  [[nodiscard]] const std::filesystem::path& root() const noexcept { return root_; }

  // Returns the bytes of a file that the cell calls `name`. A path that leads out of the root is
  // not read.
  [[nodiscard]] std::variant<std::string, FileFault> read(const std::filesystem::path& path,
                                                          const std::string& name) const {
    if (auto refused = refusal(path, name)) return *std::move(refused);
    return read_bytes(path.string());
  }
  // Why read() does not touch the file; nothing: it may.
  [[nodiscard]] std::optional<FileFault> refusal(const std::filesystem::path& path,
                                                 const std::string& name) const {
    if (leads_out_of(root_, path)) return FileFault{"'" + name + "' " + std::string(kLeadsOut)};
    if (may_read_) {
      if (auto reason = may_read_(path)) return FileFault{*std::move(reason)};
    }
    return std::nullopt;
  }

  void add(std::string_view bytes) { add(bytes, sha256(bytes)); }

  // Adds a file's bytes, and keeps its path. `digest`: their SHA-256.
  void add_file(const std::filesystem::path& path, std::string_view bytes) {
    add_file(path, bytes, sha256(bytes));
  }
  void add_file(const std::filesystem::path& path, std::string_view bytes,
                const std::string& digest) {
    add(bytes, digest);
    const auto absolute = std::filesystem::absolute(path).lexically_normal();
    if (std::ranges::find(files_, absolute) != files_.end()) return;
    files_.push_back(absolute);
    file_hashes_.push_back(digest);
  }
  // Returns absolute paths, each once, in the order in which they were added.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept { return files_; }
  // The SHA-256 of each of files().
  [[nodiscard]] const std::vector<std::string>& file_hashes() const noexcept {
    return file_hashes_;
  }
  // The SHA-256 of the digests of all that was added, one after the other.
  [[nodiscard]] std::string hash() const { return sha256(digests_); }

  // The hash is never 0, which means "not checked" on the wire.
  [[nodiscard]] std::uint64_t value() const noexcept {
    return hash_.value() == 0 ? 1 : hash_.value();
  }

 private:
  void add(std::string_view bytes, std::string_view digest) {
    hash_.add(bytes);
    digests_ += digest;
  }

  Fnv1a hash_;
  std::string digests_;
  std::filesystem::path root_;
  MayRead may_read_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::string> file_hashes_;
};

}  // namespace clearance
