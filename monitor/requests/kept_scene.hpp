// The last accepted scene in a file, from which a daemon goes on after it was killed
// (--keep-scene).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

namespace clearance {

struct KeptScene {
  // The revision of the cell file from which the changes began. If the file has another one now,
  // the scene is out of date.
  std::uint64_t began_with = 0;
  std::string yaml;  // the changed text
};

// Returns the scene in this file, nothing if there is no such file, or why it cannot be used, as a
// sentence.
[[nodiscard]] std::variant<std::optional<KeptScene>, std::string> read_kept_scene(
    const std::filesystem::path& file);

// Writes it durably. Returns why that failed, as a sentence; empty: it is kept.
[[nodiscard]] std::string keep_scene(const std::filesystem::path& file, const KeptScene& scene);

}  // namespace clearance
