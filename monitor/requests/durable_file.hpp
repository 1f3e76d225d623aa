// Files that are there wholly or not at all, also after the machine has crashed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace clearance {

// Writes a new file beside it, has the disk keep that, and gives it this name. Returns the reason
// why that failed, as a sentence; then the former file is unchanged. Empty: it is kept.
[[nodiscard]] std::string write_durably(const std::filesystem::path& file, std::string_view bytes);

// Removes what write_durably() left in this folder when its process was killed: of the file of this
// name, or of all files. Files of processes that run stay.
void remove_unfinished(const std::filesystem::path& folder, std::string_view name = {});

}  // namespace clearance
