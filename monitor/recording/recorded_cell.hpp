// The cell of a recording, with the files that the recording keeps.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "config/cell/cell_file.hpp"
#include "monitor/recording/reader.hpp"

namespace clearance {

// The media type of an attachment whose bytes are compressed.
inline constexpr std::string_view kZstdMediaType = "application/zstd";

// Returns nothing where the recording holds no cell. While the cell is read, its files stand in a
// directory of their own, at the paths that they had when they were recorded. If the recording
// keeps no files, they are looked for on this machine, beside the recording.
[[nodiscard]] std::optional<CellResult> recorded_cell(const std::filesystem::path& recording,
                                                      const RecordingOutline& outline,
                                                      CellOptions options = {});

}  // namespace clearance
