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

// Nothing where the recording holds no cell. The files stand in a directory of their own while the
// cell is read, each where it stood when it was recorded; where none are kept, they are looked for
// on this machine, beside the recording.
[[nodiscard]] std::optional<CellResult> recorded_cell(const std::filesystem::path& recording,
                                                      const RecordingOutline& outline,
                                                      CellOptions options = {});

}  // namespace clearance
