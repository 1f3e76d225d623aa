// Octomaps, by themselves or in a PlanningScene of MoveIt, as their messages show them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "monitor/intake/message_cloud.hpp"

namespace clearance {

// The bytes of a map are one element, which tells whether it is the last one again.
class MapCloud : public MessageCloud {
 public:
  [[nodiscard]] FrameFault elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                                    double& excess) const override;
  [[nodiscard]] bool is_picture() const noexcept override { return false; }
  [[nodiscard]] bool is_map() const noexcept override { return true; }
  [[nodiscard]] std::uint32_t depth_digest(std::size_t) const noexcept override;

 protected:
  void read_map(const octomap_msgs_msg_dds__Octomap_& map);

 private:
  OctomapView map_;
};

class OctomapCloud final : public MapCloud {
 public:
  Sample<octomap_msgs_msg_dds__Octomap_> sample;
  [[nodiscard]] bool read(const RawSensorMessage& message, const Sensor& sensor);
};

// Says nothing if the scene has no map: it is a change of something else. MoveIt leaves the stamp
// at 0, which counts as the time of sending.
class PlanningSceneCloud final : public MapCloud {
 public:
  Sample<moveit_msgs_msg_dds__PlanningScene_> sample;
  [[nodiscard]] bool read(const RawSensorMessage& message, const Sensor& sensor);
};

}  // namespace clearance
