// Messages about files that cannot be read or written: the attempt, the file, and the reason.
//
// Each function is called right after the failed call, since errno gives the reason.
#pragma once

#include <filesystem>
#include <string>

namespace clearance {

// "cannot read FILE: reason". Directories and special files are named as such, whatever errno is.
[[nodiscard]] std::string cannot_read(const std::filesystem::path& file);

// "cannot create FILE: reason", with the same kinds named.
[[nodiscard]] std::string cannot_create(const std::filesystem::path& file);

// "cannot write to FILE: reason"
[[nodiscard]] std::string cannot_write(const std::filesystem::path& file);

}  // namespace clearance
