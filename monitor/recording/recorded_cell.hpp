// The cells of a recording, with the files that the recording keeps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/recording/reader.hpp"

namespace clearance {

// The media type of an attachment whose bytes are compressed.
inline constexpr std::string_view kZstdMediaType = "application/zstd";

// Returns nothing where the recording holds no cell. While the cell is read, its files stand in a
// directory of their own, at the paths that they had when they were recorded. If the recording
// keeps no files, they are looked for on this machine, beside the recording. If the cell changed
// while it was recorded, this is the first one.
[[nodiscard]] std::optional<CellResult> recorded_cell(const std::filesystem::path& recording,
                                                      const RecordingOutline& outline,
                                                      CellOptions options = {});

// A scene that a recording describes (RecordingWriter::describe). The cell's files are the
// attachments in front of the description; among those of one name, the last one counts.
struct DescribedScene {
  std::uint64_t daemon = 0;  // as in Distances
  std::uint64_t revision = 0;
  SceneInForce since = {};
  std::string yaml, cell_file;
  std::string share;                // CellOptions::share
  std::filesystem::path recording;  // the file with the description
  std::uint64_t place = 0;          // its byte in that file
  std::uint64_t joined = 0;         // the number of the last state in front of it (kJoinedMetadata)
};

// All descriptions in the files of one recording, in their order. If one is repeated, the last
// one replaces those before it.
[[nodiscard]] std::vector<DescribedScene> described_scenes(
    const std::vector<std::filesystem::path>& files);

// A scene that was in force before a file began which continues a recording.
struct FormerScene {
  std::uint64_t revision = 0;
  std::vector<std::string> objects;  // their names by id
};

// Returns the scenes that the file states at its head, in their order.
[[nodiscard]] std::vector<FormerScene> former_scenes(const std::filesystem::path& file);

// Reads the cell of a description, as recorded_cell does.
[[nodiscard]] CellResult cell_of(const DescribedScene& described, CellOptions options = {});

}  // namespace clearance
