// A file opened for reading at any place, with its size at that time; or the same bytes in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>

namespace clearance {

class McapFile {
 public:
  explicit McapFile(const std::filesystem::path& path);
  explicit McapFile(std::span<const std::byte> bytes) : memory_(bytes), size_(bytes.size()) {}
  [[nodiscard]] bool open() const noexcept { return file_ != nullptr || memory_.data() != nullptr; }
  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }
  // False: not all of it is there.
  [[nodiscard]] bool read(std::uint64_t offset, std::span<std::byte> out);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> file_;
  std::span<const std::byte> memory_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace clearance
