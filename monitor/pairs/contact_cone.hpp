// The tangent cone of a part at its witness point: the directions in which it extends from there.
#pragma once

#include <cstdint>

#include "core/vec.hpp"
#include "monitor/bodies/posed_part.hpp"

namespace clearance {

class ContactCone {
 public:
  // `witness`: in the world, on the part's surface; `outward`: unit, from there to the other part.
  ContactCone(const PosedPart& part, const Vec3& witness, const Vec3& outward) noexcept;

  // False for a curved part, and for an unbounded one that has no vertex and is no half-space.
  [[nodiscard]] bool known() const noexcept { return kind_ != Kind::kUnknown; }
  // Without its radius, the part is a point.
  [[nodiscard]] bool is_point() const noexcept { return kind_ == Kind::kPoint; }
  // The witness point is inside a face, which is at right angles to `outward`.
  [[nodiscard]] bool is_plane() const noexcept { return kind_ == Kind::kFace; }

  // The extreme directions of the cone: unit, in the world. If the witness point is on an edge,
  // these are both directions along the edge, and one across it into each of its faces.
  [[nodiscard]] int edges() const noexcept;
  [[nodiscard]] Vec3 edge(int i) const noexcept;

  // The sine of the angle by which a tangent leaves the cone, 0 to 1. `tangent`: unit, in the
  // world, at right angles to `outward`.
  [[nodiscard]] double leaves(const Vec3& tangent) const noexcept;

 private:
  enum class Kind : std::uint8_t {
    kUnknown,
    kPoint,
    kSegmentEnd,  // of a part without faces
    kSegment,     // between its ends
    kVertex,
    kEdge,
    kFace,
  };

  void find(const Vec3& point, const Vec3& outward) noexcept;
  [[nodiscard]] Vec3 in_part(const Vec3& v) const noexcept;

  const ConvexBody& body_;
  const Mat3& world_from_part_;
  Kind kind_ = Kind::kUnknown;
  std::int32_t vertex_ = kNone;
  std::int32_t edge_ = kNone;  // between vertices
};

}  // namespace clearance
