// Names for files that must not be written over: NAME.EXT, NAME-2.EXT, NAME-3.EXT ...
#pragma once

#include <filesystem>

namespace clearance {

// Also what a dangling link names.
[[nodiscard]] bool is_taken(const std::filesystem::path& file);

// The next of these names: NAME-2.EXT after NAME.EXT, NAME-8.EXT after NAME-7.EXT.
[[nodiscard]] std::filesystem::path next_number(const std::filesystem::path& file);

// The file itself, or the first of its next names that is not taken.
[[nodiscard]] std::filesystem::path first_free(const std::filesystem::path& file);

}  // namespace clearance
