// The name of a pair in all programs: "hand - box". If an object has several parts, and the closest
// one has a name that the cell states, the name contains the part: "hand.finger - box".
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

// A part without a name of its own is called by its kind and place, "box0", and the parts of a mesh
// have numbers, "mesh0.3" or "NAME.3" (name_of_part()). Such names mean nothing to a person.
// Returns the name that was given, or nothing. A given name of that form counts as none.
[[nodiscard]] inline std::string_view given_name(std::string_view part) noexcept {
  constexpr std::array<std::string_view, 11> kKinds{
      "box",  "sphere",    "capsule",  "prism", "polyhedron",    "half_space",
      "mesh", "ellipsoid", "cylinder", "cone",  "truncated_cone"};
  constexpr std::string_view kDigits = "0123456789";
  const std::size_t dot = part.rfind('.');
  if (dot != part.npos && part.find_first_not_of(kDigits, dot + 1) == part.npos)
    part = part.substr(0, dot);
  const std::string_view kind = part.substr(0, part.find_last_not_of(kDigits) + 1);
  return std::ranges::find(kKinds, kind) == kKinds.end() ? part : "";
}

// "hand.finger", or "hand" if it has one part, or the part has no name of its own.
[[nodiscard]] inline std::string body_name(const std::string& object, std::size_t parts,
                                           std::string_view part) {
  const std::string_view given = parts < 2 ? "" : given_name(part);
  return given.empty() ? object : object + "." + std::string(given);
}

[[nodiscard]] inline std::string pair_name(const std::string& a, const std::string& b) {
  return a + " - " + b;
}

// `pair` is an index into Scene::pairs. A pair that does not exist is named by its number.
[[nodiscard]] std::string pair_name(const Scene& scene, std::uint32_t pair);

// The name with the closest parts.
[[nodiscard]] std::string pair_name(const Scene& scene, const PairReport& pair);

}  // namespace clearance
