// A cell for inputs that lie: balls by poses, a ball by tf, a robot whose base follows tf, a robot
// that stands in the world, and a part that commands attach. A camera on tf sees points at rest.
// One that stands sees a plate that rises and sinks, and a map has a person who walks. Bodies are
// balls, points and a rectangle, so the true distance has a closed form.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "config/cell/cell.hpp"

namespace clearance::test::lies {

inline constexpr std::int64_t kMs = 1'000'000;
inline constexpr std::int64_t kSecond = 1000 * kMs;

// Each channel is sent by a program of its own, but for the last two. A fault strikes one channel.
enum class Channel : std::uint8_t {
  kBall0,
  kBall1,
  kBall2,
  kArm,
  kPost,
  kOdom,
  kBase,
  kFollower,
  kEye,      // the frame of the camera
  kPoints,   // what the camera sees
  kPicture,  // the depth images of the lens, which sees the plate
  kMap,
  kCommands,
  kPartner,
};
inline constexpr std::size_t kChannels = 14;
[[nodiscard]] constexpr bool is_ball(Channel c) { return c <= Channel::kBall2; }
[[nodiscard]] constexpr bool is_robot(Channel c) {
  return c == Channel::kArm || c == Channel::kPost;
}
[[nodiscard]] constexpr bool is_frame(Channel c) {
  return c >= Channel::kOdom && c <= Channel::kEye;
}
[[nodiscard]] constexpr bool is_seen(Channel c) {
  return c >= Channel::kPoints && c <= Channel::kMap;
}
[[nodiscard]] constexpr bool is_sent(Channel c) { return c <= Channel::kMap; }
[[nodiscard]] const char* name(Channel channel);

// Limits that the cell states.
inline constexpr double kBallSpeed = 2.0;            // m/s, also of the ball that follows tf
inline constexpr double kBaseSpeed = 1.0;            // m/s, of the base and its parent frame
inline constexpr std::int64_t kAgeLimit = 20 * kMs;  // of balls and joints
inline constexpr std::int64_t kBaseAgeLimit = 40 * kMs;
inline constexpr double kEyeSpeed = 1.0;                 // of the camera, m/s and rad/s
inline constexpr std::int64_t kEyeAgeLimit = 100 * kMs;  // of its frame, and of pictures
inline constexpr std::int64_t kFrozenLimit = 100 * kMs;
inline constexpr std::int64_t kPicturePeriod = 20 * kMs;  // of both cameras
inline constexpr std::int64_t kMapPeriod = 50 * kMs;
inline constexpr double kSeenSpeed = 0.6;  // of the plate and of the person, m/s
// Joints in their order: shoulder, elbow (revolute), spin (continuous), push (prismatic).
inline constexpr std::size_t kJoints = 4;
inline constexpr std::array<const char*, kJoints> kJointNames{"shoulder", "elbow", "spin", "push"};
inline constexpr std::array<double, kJoints> kJointSpeed{1.5, 1.5, 2.0, 0.5};  // rad/s, m/s

// Keys of the robot that a cell may not know yet; empty: left out, and so are faults that need it.
inline constexpr const char* kBaseSpeedKey = "max_speed";  // of `base`, with the value kBaseSpeed
inline constexpr const char* kJointFrozenKey =
    "frozen_limit_ms";  // of a robot, with the value kFrozenLimit

// The lens looks down from here, with square pixels and the focal length in pixels.
inline constexpr std::array<double, 3> kLensPlace{0.5, -0.3, 6.0};  // m
inline constexpr std::uint32_t kColumns = 16, kRows = 12;
inline constexpr double kFocal = 20.0;
// The cubes of the map count from here, in all directions to larger coordinates.
inline constexpr std::array<double, 3> kMapPlace{-5.0, -5.0, -1.0};  // m
inline constexpr double kCube = 0.1;                                 // m
// Where the part lies at first, and where it is in the frame of the arm's tip.
inline constexpr std::array<double, 3> kPartPlace{-3.0, 2.5, 0.5}, kTipFromPart{0.25, 0.1, 0.0};

// A body, in the order of the true motion: balls 0 to 2, the follower, the rock, the links of the
// arm from its foot to its tip, those of the post, the points that the camera sees, the plate that
// the lens sees, the person in the map, and the part.
inline constexpr std::size_t kLinks = 5;
inline constexpr std::size_t kFollowerBody = 3, kRockBody = 4, kArmBody = 5,
                             kPostBody = kArmBody + kLinks, kEyeBody = kPostBody + kLinks,
                             kLensBody = kEyeBody + 1, kMapBody = kLensBody + 1,
                             kPartBody = kMapBody + 1, kBodies = kPartBody + 1;
// In two rows of two. None is where a body can be, which would be left out as its own image.
inline constexpr std::size_t kSeenPoints = 4;
[[nodiscard]] const char* body_name(std::size_t body);

// Reads the cell, whose files stay. All pairs are published.
[[nodiscard]] Cell lying_cell();

}  // namespace clearance::test::lies
