// Names for files that must not be overwritten: NAME.EXT, NAME-2.EXT, NAME-3.EXT ...
#pragma once

#include <filesystem>

namespace clearance {

// True also for the name of a dangling link.
[[nodiscard]] bool is_taken(const std::filesystem::path& file);

// The next of these names: NAME-2.EXT after NAME.EXT, NAME-8.EXT after NAME-7.EXT.
[[nodiscard]] std::filesystem::path next_number(const std::filesystem::path& file);

// The file itself if it is free, else the first free one of its next names.
[[nodiscard]] std::filesystem::path first_free(const std::filesystem::path& file);

}  // namespace clearance
