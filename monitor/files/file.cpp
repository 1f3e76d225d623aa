// Reads with fseeko and fread, whose buffer makes the many small reads of record headers cheap. The
// position is remembered, since seeking would empty that buffer.
#include "monitor/files/file.hpp"

#include <sys/stat.h>
#include <sys/types.h>

#include <algorithm>

namespace clearance {

McapFile::McapFile(const std::filesystem::path& path) : file_(open_file(path)) {
  struct stat status {};
  if (!file_) return;
  if (::fstat(::fileno(file_.get()), &status) != 0) {
    file_.reset();
    return;
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
}

// Checked without sums that could overflow: offset and size come from the file.
bool McapFile::read(std::uint64_t offset, std::span<std::byte> out) {
  if (offset > size_ || out.size() > size_ - offset) return false;
  if (!file_) {
    std::ranges::copy(memory_.subspan(static_cast<std::size_t>(offset), out.size()), out.begin());
    return true;
  }
  if (offset != position_ && ::fseeko(file_.get(), static_cast<off_t>(offset), SEEK_SET) != 0) {
    return false;
  }
  const std::size_t read = std::fread(out.data(), 1, out.size(), file_.get());
  position_ = offset + read;
  return read == out.size();
}

}  // namespace clearance
