// The files of the page, compiled into the program, so that it needs no folder beside it.
#pragma once

#include <span>
#include <string_view>

namespace clearance::view {

struct PageFile {
  std::string_view path;  // "/main.js"
  std::string_view text;
};
[[nodiscard]] std::span<const PageFile> page_files() noexcept;

// The type follows from the name's ending.
[[nodiscard]] std::string_view content_type(std::string_view path) noexcept;

}  // namespace clearance::view
