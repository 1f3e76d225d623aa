// The ROS 2 messages for viewers, transforms and markers, in the types of idl/ros2.idl.
//
// The schemas are the definitions of tf2_msgs and visualization_msgs, from Humble on, as `ros2msg`
// text. MCAP files and Foxglove's protocol contain them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.hpp"
#include "monitor/files/format.hpp"
#include "monitor/wire/dds_sample.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance::ros {

inline constexpr std::string_view kSchemaEncoding = "ros2msg";
[[nodiscard]] const McapSchema& transforms_schema();  // tf2_msgs/msg/TFMessage
[[nodiscard]] const McapSchema& markers_schema();     // visualization_msgs/msg/MarkerArray

// The pose of the frame `child` in the frame `world`.
struct Transform {
  std::string child;
  Pose pose;
};
inline constexpr std::string_view kWorldFrame = "world";

struct Colour {
  float red = 0.5F, green = 0.5F, blue = 0.5F, opacity = 1.0F;
};

// The fields of visualization_msgs/msg/Marker that are used here; the others stay empty.
enum class MarkerType : std::int32_t { kLineList = 5, kText = 9, kTriangles = 11 };
struct Marker {
  std::string_view frame = kWorldFrame, name_space = {};
  std::int32_t id = 0;
  MarkerType type = MarkerType::kTriangles;
  Pose pose = {};
  Vec3 scale = Vec3::Ones();  // m; x is the width of lines, z the height of text
  Colour colour = {};
  std::vector<Vec3> points = {};
  std::vector<Colour> colours = {};  // none, or one per point
  std::string text = {};
  bool deleted = false;
};

using TransformMessage = tf2_msgs_msg_dds__TFMessage_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;

// Every header gets `stamp_ns`; 0 means any time.
[[nodiscard]] Sample<TransformMessage> transform_message(std::int64_t stamp_ns,
                                                         std::span<const Transform> transforms);
[[nodiscard]] Sample<MarkerArray> marker_array(std::int64_t stamp_ns,
                                               std::span<const Marker> markers);

}  // namespace clearance::ros
