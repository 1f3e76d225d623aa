// Reads `person:` of a robot in a cell file.
#pragma once

#include <string>

#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

struct PersonKeys {
  double stature = 0.0;  // m
  double error = 0.0;    // m: no point of the body is farther outside the capsules
  std::string id;        // as Person::id
};

// `robot` is the map of the whole robot, whose keys that no person can have are refused; `name` is
// its name, which is the id of a body where none is stated.
[[nodiscard]] PersonKeys read_person(const YamlNode& node, const std::string& name,
                                     MapReader& robot, const Quantities& quantities);

}  // namespace clearance
