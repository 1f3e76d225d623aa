// Pairs of bodies and motions that are hard for a distance algorithm, from seeds: the same
// everywhere.
//
// The families follow what has broken distance code: features parallel up to a tilt, aspect ratios
// to 1e6, contact to the last bit, overlap by less than rounding, units from 1e-9 to 1e9, poses far
// from the world's origin, bodies without end. Gaps are set with the exact oracle.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/pose.hpp"
#include "tests/shared/hard_bodies.hpp"

namespace clearance::hard {

struct HardCase {
  std::string note;
  Body a, b;
  Pose pose_a, pose_b;
};

struct HardMotion {
  std::string note;
  Body a, b;
  std::vector<std::pair<Pose, Pose>> poses;
};

struct CaseFamily {
  const char* name;
  HardCase (*make)(Random&);
};

struct MotionFamily {
  const char* name;
  HardMotion (*make)(Random&, int steps);
};

[[nodiscard]] std::span<const CaseFamily> case_families();
[[nodiscard]] std::span<const MotionFamily> motion_families();
// The case of this seed. Throws std::invalid_argument when there is no such family.
[[nodiscard]] HardCase case_of(const std::string& family, std::uint64_t seed);

// Moves B along the line between the closest points until the gap is about `gap` (negative:
// overlapping by that much). The pair must be apart to begin with, else nothing is moved.
void set_gap(HardCase& pair, double gap);
// Both bodies together, about the world's origin, and then by a shift.
void move_together(HardCase& pair, const Eigen::Quaterniond& turn,
                   const Vec3& shift = Vec3::Zero());

// One line of the case format of clearance-distance, to keep and to send.
[[nodiscard]] std::string json_line(const std::string& id, const std::string& family,
                                    const HardCase& pair);
[[nodiscard]] std::string json_line(const std::string& id, const std::string& family,
                                    const HardMotion& motion);

}  // namespace clearance::hard
