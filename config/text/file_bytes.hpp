// Opens, reads and writes the files that cells, command lines and bags name.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace clearance {

// Opens a regular file for reading. It never waits, as for a writer of a FIFO. Returns the
// descriptor, which the caller closes, or -1 with errno: EISDIR for a folder, EINVAL for a FIFO, a
// device or a socket.
[[nodiscard]] int open_to_read(const std::filesystem::path& path) noexcept;

struct CloseFile {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
// Null: it was not opened; errno as from open_to_read().
[[nodiscard]] std::unique_ptr<std::FILE, CloseFile> open_file(
    const std::filesystem::path& path) noexcept;

// `reason` is a clause: "'x.stl' cannot be opened: ...".
struct FileFault {
  std::string reason;
};

// Returns the bytes of a regular file, at most 256 MiB, or why there are none.
[[nodiscard]] std::variant<std::string, FileFault> read_bytes(const std::string& path);

// Writes all of this, where the kernel may take less at once. False: it has failed, with errno, and
// a part may be written.
[[nodiscard]] bool write_bytes(int descriptor, std::string_view bytes) noexcept;

}  // namespace clearance
