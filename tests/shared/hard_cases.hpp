// Pairs of bodies and motions that are hard for a distance algorithm. A seed gives the same case on
// every platform.
//
// The families contain what has broken distance code: features parallel up to a tilt, aspect ratios
// to 1e6, and contact to the last bit. Other families contain overlap by less than rounding, units
// from 1e-9 to 1e9, poses far from the world's origin and unbounded bodies. Gaps are set with the
// exact oracle.
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
// The case of this seed. Throws std::invalid_argument if there is no such family.
[[nodiscard]] HardCase case_of(const std::string& family, std::uint64_t seed);

// Moves B along the line between the closest points until the gap is about `gap`; a negative gap is
// an overlap of that depth. Bodies that overlap beforehand are not moved.
void set_gap(HardCase& pair, double gap);
// Rotates both bodies together about the world's origin, and then translates them.
void move_together(HardCase& pair, const Eigen::Quaterniond& turn,
                   const Vec3& shift = Vec3::Zero());

// One line in the case format of clearance-distance, to store or to send.
[[nodiscard]] std::string json_line(const std::string& id, const std::string& family,
                                    const HardCase& pair);
[[nodiscard]] std::string json_line(const std::string& id, const std::string& family,
                                    const HardMotion& motion);

}  // namespace clearance::hard
