// A cell and its reports as transforms and markers, for any viewer of ROS 2 messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "monitor/visual/object_poses.hpp"
#include "monitor/visual/ros_types.hpp"

namespace clearance {

// Topics of what is made here.
inline constexpr const char* kTransformsTopic = "/tf";
inline constexpr const char* kBodiesTopic = "/clearance/bodies";
inline constexpr const char* kClosestTopic = "/clearance/closest";

// A TFMessage with every object whose pose is known, each in a frame of its own name.
[[nodiscard]] std::vector<std::byte> transforms_message(const Scene& scene,
                                                        const ObjectPoses& poses,
                                                        std::int64_t stamp_ns);

// A MarkerArray of all parts, in their objects' frames: sent once. Half-spaces are large thin
// slabs' faces.
[[nodiscard]] std::vector<std::byte> bodies_message(const Scene& scene);

// The same for a system of ROS 2, whose tf has the frames that objects follow and those of robots'
// links, but none of fixed objects: these are in the frame `world`.
[[nodiscard]] std::vector<std::byte> bodies_message_for_tf(const Scene& scene,
                                                           const std::string& world);

// A MarkerArray of the closest pair of the report and of those pairs that lie in one of the cell's
// zones: a line between witness points and the distance beside it. What is stale or unknown has no
// line. `world`: the frame of all of it.
[[nodiscard]] std::vector<std::byte> closest_message(const Scene& scene,
                                                     const clearance_msg_Distances& report,
                                                     std::int64_t stamp_ns,
                                                     std::string_view world = ros::kWorldFrame);

}  // namespace clearance
