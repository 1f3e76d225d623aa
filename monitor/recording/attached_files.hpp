// The files that a cell was read from, as a recording keeps them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/recording/options.hpp"

namespace clearance {

struct AttachedFile {
  std::string name, media_type;  // the absolute path; kZstdMediaType if compressed
  std::vector<std::byte> bytes;
  std::uint64_t revision = 0;  // of the content before compression
};

struct AttachedFiles {
  std::vector<AttachedFile> files;
  std::string cell_file;  // the path of the cell; empty: no files are kept
  // The reason why the files that the cell names are not kept. Empty: they are, or there are none.
  std::string missing;
};

// Reads and compresses the files. Those that are in `before` with the same content are taken from
// there. If one cannot be read, or they are larger than RecordingOptions::attach_bytes, none is
// kept.
[[nodiscard]] AttachedFiles attached_files(const Cell& cell, const RecordingOptions& options,
                                           const AttachedFiles& before = {});

}  // namespace clearance
