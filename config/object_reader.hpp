// Reads the objects of a cell file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/quantities.hpp"
#include "config/scene.hpp"
#include "config/shape_reader.hpp"

namespace clearance {

// What an object has when it does not say otherwise: the `defaults:` section.
struct ObjectDefaults {
  double margin = 0.0;           // m
  double max_speed = kInfinity;  // m/s
  std::int64_t age_limit_ns = 20'000'000;
};

// Objects with what they were read from, so that later sections can complain about them.
struct ObjectList {
  std::vector<Object> objects;
  std::vector<const YamlNode*> places;  // of each object: where its name stands
  bool names_known = true;  // false: some name or group could not be read; others may seem unknown
};

[[nodiscard]] ObjectDefaults read_defaults(const YamlNode& node, const Quantities& quantities);

[[nodiscard]] ObjectList read_objects(const YamlNode& node, const ObjectDefaults& defaults,
                                      const Quantities& quantities, ShapeReader& shapes);

}  // namespace clearance
