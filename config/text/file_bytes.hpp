// Reads the files that a cell names.
#pragma once

#include <string>
#include <variant>

namespace clearance {

// `reason` ends a sentence: "'x.stl' cannot be opened: ...".
struct FileFault {
  std::string reason;
};

// Returns the bytes of a file, at most 256 MiB, or why there are none.
[[nodiscard]] std::variant<std::string, FileFault> read_bytes(const std::string& path);

}  // namespace clearance
