// The ids of bodies in ROS4HRI (REP-155).
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace clearance {

// Names of joints and frames end with the id, so it has letters, digits and '_' only.
[[nodiscard]] inline bool is_body_id(std::string_view id) noexcept {
  constexpr std::size_t kMost = 32;
  return !id.empty() && id.size() <= kMost && std::ranges::all_of(id, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace clearance
