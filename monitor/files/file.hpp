// A file opened for reading at any place, with its size at that time; or the same bytes in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "config/text/file_bytes.hpp"

namespace clearance {

// Owns the file handle. Only one thread may use it at a time, since it has one position.
class McapFile {
 public:
  // A file that cannot be opened, or is not a regular one, gives open() == false; errno says why.
  explicit McapFile(const std::filesystem::path& path);
  // The bytes must outlive this.
  explicit McapFile(std::span<const std::byte> bytes) : memory_(bytes), size_(bytes.size()) {}
  [[nodiscard]] bool open() const noexcept { return file_ != nullptr || memory_.data() != nullptr; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  // Fills `out` from this place of the file; false when the file ends before.
  [[nodiscard]] bool read(std::uint64_t offset, std::span<std::byte> out);

 private:
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::span<const std::byte> memory_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace clearance
