// The ROS 2 messages that viewers draw: transforms and markers, as CDR bytes without ROS or DDS.
//
// Layouts are those of tf2_msgs and visualization_msgs from Humble on; the schemas are their
// definitions as `ros2msg` text, which MCAP files and Foxglove's protocol carry along.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pose.hpp"
#include "monitor/mcap/format.hpp"

namespace clearance::ros {

inline constexpr std::string_view kSchemaEncoding = "ros2msg";
[[nodiscard]] const McapSchema& transforms_schema();  // tf2_msgs/msg/TFMessage
[[nodiscard]] const McapSchema& markers_schema();     // visualization_msgs/msg/MarkerArray

// Frame `child` in frame `world`.
struct Transform {
  std::string_view child;
  Pose pose;
};
inline constexpr std::string_view kWorldFrame = "world";

struct Colour {
  float red = 0.5F, green = 0.5F, blue = 0.5F, opacity = 1.0F;
};

// visualization_msgs/msg/Marker, as far as it is used here; what is left out is empty.
enum class MarkerType : std::int32_t { kLineList = 5, kText = 9, kTriangles = 11 };
struct Marker {
  std::string_view frame = kWorldFrame, name_space = {};
  std::int32_t id = 0;
  MarkerType type = MarkerType::kTriangles;
  Pose pose = {};
  Vec3 scale = Vec3::Ones();  // m; of lines: x is their width; of text: z is its height
  Colour colour = {};
  std::vector<Vec3> points = {};
  std::vector<Colour> colours = {};  // none, or one a point
  std::string text = {};
  bool deleted = false;
};

// CDR of a TFMessage and of a MarkerArray, with their encapsulation header. `stamp_ns` goes into
// every header; 0: any time.
[[nodiscard]] std::vector<std::byte> encode(std::int64_t stamp_ns,
                                            std::span<const Transform> transforms);
[[nodiscard]] std::vector<std::byte> encode(std::int64_t stamp_ns, std::span<const Marker> markers);

}  // namespace clearance::ros
