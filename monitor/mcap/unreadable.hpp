// Why a file cannot be read, in words.
#pragma once

#include <filesystem>
#include <string>

namespace clearance {

// "cannot read FILE: REASON". To be called where opening it has just failed: errno tells.
[[nodiscard]] std::string unreadable(const std::filesystem::path& file);

}  // namespace clearance
