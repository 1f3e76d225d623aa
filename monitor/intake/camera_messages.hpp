// Decodes the messages of a camera, and refuses with a cause what is not a whole frame of it.
//
// A refused frame changes nothing: the frame before stays in use and grows old. Nothing here makes
// anything clear.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "monitor/clouds/depth_cloud.hpp"
#include "monitor/intake/octomap_tree.hpp"
#include "monitor/wire/camera_types.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/moveit_types.hpp"

namespace clearance {

enum class FrameFault : std::uint8_t {
  kNoFault,
  // Faults that one message shows by itself.
  kUndecodable,    // the bytes are not a message of the type: cut, or with lengths that lie
  kEncoding,       // neither 16UC1 nor 32FC1
  kByteOrder,      // not that of this machine, or not the stated one
  kNoPixels,       // a width or height of 0
  kTooManyPixels,  // more than the memory that the cell fixes
  kStep,           // rows or points overlap: step 0, or below the size of their content
  kShortData,      // fewer bytes than the size says: half a frame
  kFields,         // x, y or z is missing, twice there, no single float32, or outside of the point;
                   // or a time of a type whose unit is not known
  kLayout,         // numbers overlap, or rows, angles or counts are not those of its numbers
  kLongScan,       // its rays or points were measured over more time than the stamp is off
  kIntrinsics,  // focal lengths that are not positive, numbers that are not finite, or P unlike K
  kDistorted,   // a distortion, rotation, binning or region: the image is not a plain pinhole's
  // Faults that the messages before it show.
  kNoCameraInfo,       // no image can be used before the first CameraInfo
  kCameraInfoChanged,  // images are refused until the first CameraInfo comes again
  kSizeChanged,        // the image has another size than its CameraInfo
  kOtherCamera,        // the image and its CameraInfo name different frames
  kNoStamp,            // a stamp of 0
  kOtherClock,         // the stamp is far from the time of sending
  kOldStamp,           // not newer than the frame before
  kFrozen,             // nearly all of the depth of one of the last frames, under a newer stamp
  kSecondPublisher,    // the writer of the frames in use is still heard
  kTooOften,           // more frames than the cell states
  kFrameChanged,       // its frame_id is not that of the first frame of the stream
  kFormChanged,        // its encoding, size, steps or fields are not those of the first one
  // Faults that show when a frame is built.
  kNoPlace,  // no transform leads from its frame to the cell, or where it was mounted is unknown
  kLateTransforms,  // no transform at or after its stamp has come in time, and no speed is stated
  kCannotBuild,     // a picture too wide, or more points within the range than the cell states
  kNothingSeen,     // nothing within the range but the robot, and too little of known bodies
  kBeforeJoints,    // joints were first heard after the stamp: the robot's image is taken for an
                    // obstacle
  kNotOrganised,    // points in one row, where the cell says that their neighbours are known
  kOctree,       // of a map: the tree is cut, too deep, of an unknown kind or without a resolution
  kWideRays,     // of organised points: no ball may span the distance from one ray to the next
  kUnknownRays,  // of organised points: too few show how far apart the rays are
  kFewSeen,      // a smaller share of its elements has depth than the cell states
  kSeenFell,     // far fewer of its elements have depth than of the frame before
  kRobotElsewhere,  // tf places the camera, and a robot elsewhere than the cell does
  kTooNear,         // of points: one is nearer than can be measured, and no ray says where
};
inline constexpr std::size_t kFrameFaults = 38;

// A sentence without its end: what is wrong with the message.
[[nodiscard]] const char* text(FrameFault fault) noexcept;
// The cause as health and the log list it; empty for kNoFault.
[[nodiscard]] const char* name(FrameFault fault) noexcept;

// The points of a PointCloud2: x, y and z are float32 at these offsets of each point.
struct PointsView {
  // When each point was measured: an offset in ns, or a time in s or ns.
  enum class Times : std::uint8_t { kNotSent, kUint32, kFloat32, kFloat64 };
  std::uint32_t width = 0, height = 0;  // height 1: not organised
  std::size_t point_step = 0, row_step = 0;
  std::size_t x = 0, y = 0, z = 0, time = 0;
  Times times = Times::kNotSent;
  std::span<const std::byte> bytes;
};

// Views of a message's own memory. They are written only if the result is kNoFault.
[[nodiscard]] FrameFault view(const sensor_msgs_msg_dds__Image_& message, std::size_t most_pixels,
                              DepthImage& out) noexcept;
[[nodiscard]] FrameFault view(const sensor_msgs_msg_dds__PointCloud2_& message,
                              std::size_t most_points, PointsView& out) noexcept;
[[nodiscard]] FrameFault view(const sensor_msgs_msg_dds__CameraInfo_& message,
                              PinholeCamera& out) noexcept;
[[nodiscard]] FrameFault view(const octomap_msgs_msg_dds__Octomap_& message,
                              OctomapView& out) noexcept;

}  // namespace clearance
