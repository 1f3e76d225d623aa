// Reads when a cell is ticked, and how much a tick may do.
#pragma once

#include "config/scene/scene.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Values for which mistakes show only when all else is read; null: not stated.
struct TimingPlaces {
  const YamlNode* budget = nullptr;
  const YamlNode* followed = nullptr;  // the robot or the object that ticks follow
};

// Reads rate, budget and time limits of a cell. A key that it leaves out keeps the default of
// Scene.
[[nodiscard]] TimingPlaces read_timing(MapReader& map, const Quantities& quantities, Scene& scene);

// Once robots and objects are known: finds the one that ticks follow, or reports it.
void find_followed(const TimingPlaces& places, Diagnostics& diagnostics, Scene& scene);

}  // namespace clearance
