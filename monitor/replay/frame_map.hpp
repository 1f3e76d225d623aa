// Images of a recording's sensors as images of another cell, with which the recording is replayed.
#pragma once

#include <optional>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/scene_map.hpp"
#include "monitor/sensors/sensors.hpp"

namespace clearance {

// Sensors, joints, objects and robots are found again by their names. An image is used if the cell
// has the same entry for its sensor, and its carrier is placed as recorded. A
// joint or object that the recording lacks is unknown, so that it hides nothing.
class FrameMap {
 public:
  // Both scenes must outlive this.
  FrameMap(const Scene& recorded, const Scene& now);

  // Nothing: it is of no use.
  [[nodiscard]] std::optional<BuiltFrame> translate(const BuiltFrame& frame) const;

 private:
  // False: it is elsewhere in this cell.
  [[nodiscard]] bool translate(Carrier& carrier) const;
  [[nodiscard]] PlacedPostures translate(const PlacedPostures& recorded) const;

  const Scene &recorded_, &now_;
  SceneMap map_;
  // By index in the cell: the index in the recording, or SceneMap::kNone.
  std::vector<std::uint32_t> variables_, objects_;
};

}  // namespace clearance
