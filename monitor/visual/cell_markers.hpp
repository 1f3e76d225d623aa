// A cell and its reports as transforms and markers, for viewers of ROS 2 messages.
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

// Holds every object whose pose is known, each as a frame of the object's name.
[[nodiscard]] Sample<ros::TransformMessage> transforms_message(const Scene& scene,
                                                               const ObjectPoses& poses,
                                                               std::int64_t stamp_ns);

// Holds all parts, in the frames of their objects. A half-space is the face of a large thin slab.
[[nodiscard]] Sample<ros::MarkerArray> bodies_message(const Scene& scene);

// The same for a system of ROS 2. Its tf has the frames that objects follow and the frames of the
// robots' links, but none of fixed objects: their parts are in the frame `world`.
[[nodiscard]] Sample<ros::MarkerArray> bodies_message_for_tf(const Scene& scene,
                                                             const std::string& world);

// Holds the closest pair of the report and the pairs inside one of the cell's zones: a line between
// the witness points of each, and the distance beside it. Stale and unknown pairs have no line.
// Everything is in the frame `world`.
[[nodiscard]] Sample<ros::MarkerArray> closest_message(const Scene& scene,
                                                       const clearance_msg_Distances& report,
                                                       std::int64_t stamp_ns,
                                                       std::string_view world = ros::kWorldFrame);

}  // namespace clearance
