// The ids of bodies in ROS4HRI (REP-155).
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace clearance {

inline constexpr std::size_t kLongestBodyId = 32;

// Names of joints and frames end with the id, so it has letters, digits and '_' only.
[[nodiscard]] inline bool is_body_id(std::string_view id) noexcept {
  return !id.empty() && id.size() <= kLongestBodyId && std::ranges::all_of(id, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

// The names of a person's joints and of its frame end with it. Without an id, no body has it.
[[nodiscard]] inline std::string body_name(const std::string& id, const std::string& robot) {
  return id.empty() ? robot + "?" : id;
}

}  // namespace clearance
