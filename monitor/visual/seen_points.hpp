// Turns the frame of a sensor into points, for viewers of ROS 2 messages.
#pragma once

#include <cstddef>
#include <cstdint>

#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/files/format.hpp"
#include "monitor/visual/ros_types.hpp"
#include "monitor/wire/camera_types.hpp"

namespace clearance {

// The topic of these messages.
inline constexpr const char* kSeenTopic = "/clearance/seen";
[[nodiscard]] const McapSchema& seen_points_schema();  // sensor_msgs/msg/PointCloud2

// Contains the middles of at most `most` elements that queries meet, evenly chosen, in the frame
// `world`. Fields: x, y and z as float32 (m), and `sensor`, its number in Scene::sensors as uint32.
// Nothing is decided by them: a distance is that of the whole elements.
[[nodiscard]] Sample<sensor_msgs_msg_dds__PointCloud2_> seen_points_message(
    const SeenCloud& cloud, const Pose& world_from_sensor, std::uint32_t sensor,
    std::int64_t stamp_ns, std::size_t most);

}  // namespace clearance
