// Transforms and markers of a cell and its reports, for viewers of ROS 2 messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "clearance.h"
#include "config/scene/scene.hpp"
#include "monitor/visual/object_poses.hpp"
#include "monitor/visual/ros_types.hpp"

namespace clearance {

// The topics of these messages.
inline constexpr const char* kTransformsTopic = "/tf";
inline constexpr const char* kBodiesTopic = "/clearance/bodies";
inline constexpr const char* kClosestTopic = "/clearance/closest";

// Before the names of links in frames of where a robot comes to stand.
inline constexpr const char* kStandstillFrames = "standstill/";

// Contains every object with a known pose, as a frame under the object's name, and the links of
// ObjectPoses::at_standstill().
[[nodiscard]] Sample<ros::TransformMessage> transforms_message(const Scene& scene,
                                                               const ObjectPoses& poses,
                                                               std::int64_t stamp_ns);

// Contains all parts, in the frames of their objects. A half-space is drawn as a large thin slab.
// What sensors see is left out (seen_points.hpp).
[[nodiscard]] Sample<ros::MarkerArray> bodies_message(const Scene& scene);

// The same markers for a ROS 2 system. Its tf has the frames that objects follow and the frames of
// the robots' links. It has no frames of fixed objects, so their parts are in the frame `world`.
[[nodiscard]] Sample<ros::MarkerArray> bodies_message_for_tf(const Scene& scene,
                                                             const std::string& world);

// Contains the closest pair of the report and the pairs inside one of the cell's zones. Each has a
// line between its witness points, and the distance beside it. Stale and unknown pairs have no
// line. Everything is in the frame `world`.
[[nodiscard]] Sample<ros::MarkerArray> closest_message(const Scene& scene,
                                                       const clearance_msg_Distances& report,
                                                       std::int64_t stamp_ns,
                                                       std::string_view world = ros::kWorldFrame);

}  // namespace clearance
