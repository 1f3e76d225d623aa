// Messages about files that cannot be read or written: what was attempted, the file, and why.
//
// Each is called right after the call that failed: the reason is what errno says then.
#pragma once

#include <filesystem>
#include <string>

namespace clearance {

// "cannot read FILE: reason". Directories and special files are named as such, whatever errno says.
[[nodiscard]] std::string cannot_read(const std::filesystem::path& file);

// "cannot create FILE: reason", with the same kinds named.
[[nodiscard]] std::string cannot_create(const std::filesystem::path& file);

// "cannot write to FILE: reason"
[[nodiscard]] std::string cannot_write(const std::filesystem::path& file);

}  // namespace clearance
