// Refuses cells that state too little for the stops of their robots and zones.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/cell/robot_reader.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/diagnostics.hpp"

namespace clearance {

// The robots whose stops are stated, and all that joints of theirs move: links, what is attached to
// them, and robots that stand on them.
class StoppingRobots {
 public:
  StoppingRobots(std::span<const Robot> robots, std::span<const Object> objects);

  [[nodiscard]] bool move(std::uint32_t object) const noexcept { return is_moved_[object]; }
  [[nodiscard]] const Robot* first() const noexcept { return first_; }  // null: there is none

 private:
  const Robot* first_ = nullptr;
  std::vector<bool> is_moved_;
};

// While a robot stops, all else moves on. Reports each tracked object, sensor and base on tf
// without a largest speed, if there is a robot that stops.
void refuse_unbounded_motion(const StoppingRobots& stopping, const RobotList& robots,
                             const ObjectList& list, Diagnostics& diagnostics);

// Reports each zone with `stops` whose pairs have no body that a robot with `stopping` moves.
// `node` is the list of the zones.
void refuse_zones_without_stops(const YamlNode& node, const StoppingRobots& stopping,
                                std::span<const Zone> zones, std::span<const ObjectPair> pairs,
                                Diagnostics& diagnostics);

}  // namespace clearance
