// Recorded motion of a person in a BVH file, with kinematics of its own: nothing of the daemon's is
// used to place the body.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/vec.hpp"

namespace clearance::people {

// Each joint stands behind its parent. Ends of chains are joints without channels, of the name
// PARENT_end.
struct BvhJoint {
  std::string name;
  std::size_t parent = 0;         // of the root: 0
  Vec3 offset = Vec3::Zero();     // in the frame of the parent, in the unit of the file
  std::vector<char> channels;     // x y z: positions; X Y Z: rotations, in the order of the file
  std::size_t first_channel = 0;  // in a frame
};

struct Bvh {
  std::vector<BvhJoint> joints;
  std::vector<std::vector<double>> frames;  // the channels of all joints
  double frame_s = 0.0;
};

// Throws std::invalid_argument, with what was found, if the text is no BVH file.
[[nodiscard]] Bvh read_bvh(std::string_view text);

// Returns where the joints are, in the frame and the unit of the file.
[[nodiscard]] std::vector<Vec3> places_of(const Bvh& motion, std::size_t frame);

// The places of the joints of a person, in the world: z up, and x forward in the rest pose.
struct Keypoints {
  Vec3 neck, head_top;
  // Left, then right.
  std::array<Vec3, 2> shoulder, elbow, wrist, fingertip, hip, knee, ankle, toe;
};

// Reads the joints of the usual names: Hips, LeftUpLeg, LeftLeg, LeftFoot, LeftArm, LeftForeArm,
// LeftHand, Neck, Head ... `metres`: the unit of the file, whose y is up and whose z is forward.
// Throws std::invalid_argument if a joint is missing.
[[nodiscard]] Keypoints keypoints_of(const Bvh& motion, std::size_t frame, double metres);

}  // namespace clearance::people
