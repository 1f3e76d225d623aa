#include "monitor/intake/map_clouds.hpp"

#include <cmath>

#include "monitor/intake/digest.hpp"
#include "monitor/intake/stamp_check.hpp"
#include "monitor/intake/tf_tree.hpp"

namespace clearance {

FrameFault MapCloud::elements(const Sensor& sensor, std::vector<MeasuredPoint>& out,
                              double& excess) const {
  const OctomapFault found = occupied_cubes(map_, sensor.most_points, out, excess);
  if (found == OctomapFault::kNoFault) return FrameFault::kNoFault;
  return found == OctomapFault::kTooMany ? FrameFault::kTooManyPixels : FrameFault::kOctree;
}

std::uint32_t MapCloud::depth_digest(std::size_t) const noexcept {
  Digest digest;
  digest.add(map_.bytes);
  return static_cast<std::uint32_t>(digest.value() >> 32) | 1U;
}

void MapCloud::read_map(const octomap_msgs_msg_dds__Octomap_& map) {
  fault = view(map, map_);
  form = form_of(frame, map_);
  columns = rows = 1;
}

bool OctomapCloud::read(const RawSensorMessage&, const Sensor&) {
  stamp_ns = clearance::stamp_ns(sample->header);
  frame = frame_name(sample->header.frame_id);
  read_map(*sample);
  return true;
}

bool PlanningSceneCloud::read(const RawSensorMessage& message, const Sensor&) {
  const octomap_msgs_msg_dds__OctomapWithPose_& map = sample->world.octomap;
  if (map.octomap.data._length == 0) return false;
  stamp_ns = clearance::stamp_ns(map.header);
  is_stamped = stamp_ns != 0;
  if (!is_stamped) stamp_ns = message.sent_ns;
  frame = frame_name(map.header.frame_id);
  const auto& [position, orientation] = map.origin;
  frame_from_sensor.position = {position.x, position.y, position.z};
  frame_from_sensor.orientation.coeffs() << orientation.x, orientation.y, orientation.z,
      orientation.w;
  read_map(map.octomap);
  // The negated comparison refuses NaN.
  if (!(std::abs(frame_from_sensor.orientation.norm() - 1.0) <= kSampleUnitTolerance &&
        frame_from_sensor.position.allFinite())) {
    fault = FrameFault::kNoPlace;
  }
  return true;
}

}  // namespace clearance
