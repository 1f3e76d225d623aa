// A rival of `clearance-bench --suite`: a library that answers the distance of two bodies.
//
// Only plain numbers occur here. Adapters of installed rivals are compiled with all instructions of
// this machine, and then Eigen's types have another alignment than in the rest of the program.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace clearance {
struct ConvexBody;
struct Pose;
}  // namespace clearance

namespace clearance::bench {

using Numbers3 = std::array<double, 3>;

// world_from_body: a unit quaternion as w, x, y, z, and the position of the body's origin, m.
struct PlainPose {
  std::array<double, 4> quaternion;
  Numbers3 position;
  const Pose* pose = nullptr;  // the same pose, for adapters without flags of their own
};

// A body in its own frame, in metres. A rival should use its own shape of this kind where it has
// one.
struct PlainBody {
  enum class Kind { kHull, kBox, kSphere, kCapsule, kCylinder, kCone, kEllipsoid };
  Kind kind = Kind::kHull;
  std::vector<Numbers3> points;         // kHull, kBox: the vertices
  std::vector<std::vector<int>> faces;  // of `points`, counter-clockwise when viewed from outside
  Numbers3 half{};                      // kBox: half extents; kEllipsoid: semi-axes
  double radius = 0.0;                  // of a sphere, capsule or cylinder; of a cone's base
  // Along z: half of a capsule's axis, of a cylinder's or of a cone's height. The base of a cone is
  // at -half_length, its apex at half_length.
  double half_length = 0.0;
  const ConvexBody* body = nullptr;  // the same body, for adapters without flags of their own
};

// One pair of bodies of a rival, with what it remembers between queries.
class RivalPair {
 public:
  RivalPair() = default;
  RivalPair(const RivalPair&) = delete;
  RivalPair& operator=(const RivalPair&) = delete;
  virtual ~RivalPair() = default;
  virtual void forget() = 0;  // the next query is cold
  // The signed distance, m: minus the depth where bodies overlap, if the rival has depths, else 0
  // or less. NaN: the rival reports a failure. Infinity: the bodies are disjoint, and the rival
  // says no more.
  virtual double distance(const PlainPose& world_from_a, const PlainPose& world_from_b) = 0;
};

struct Rival {
  std::string name;
  std::string setting;    // tolerance, warm start, number type: a line of the table
  bool has_depth = true;  // false: cases of overlapping bodies are not asked
  // A null pointer if the rival has no shape for one of the bodies. The bodies outlive the pair.
  std::function<std::unique_ptr<RivalPair>(const PlainBody& a, const PlainBody& b)> pair;
};

// The quaternion as a rotation matrix, by rows.
inline std::array<Numbers3, 3> rotation_of(const PlainPose& pose) {
  const auto& [w, x, y, z] = pose.quaternion;
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

}  // namespace clearance::bench
