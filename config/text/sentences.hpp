// Lists and counts in sentences for people.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace clearance {

// "'a', 'b' or 'c'".
[[nodiscard]] std::string one_of(std::span<const std::string> names);

// "a, b, c and 4 more", where `most` is 3.
[[nodiscard]] std::string listed(std::span<const std::string> names, std::size_t most);

// "1 part", "2 parts".
[[nodiscard]] std::string counted(std::size_t count, std::string_view singular);

}  // namespace clearance
