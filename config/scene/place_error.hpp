// Stated errors of places, as bounds (stated_errors.hpp), and what carries a body that stands
// still.
#pragma once

#include <cstdint>

namespace clearance {

// A body is within this of its place: its frame's origin by `translation`, m, in any direction, and
// its orientation by `rotation`, rad, about any axis.
struct PlaceError {
  double translation = 0.0, rotation = 0.0;
  [[nodiscard]] bool any() const noexcept { return translation > 0.0 || rotation > 0.0; }
};

// The error of a joint: of its position, and of its frame in the parent link. `position` is of
// joints that rotate, rad; `slide` of those that slide, m. Planar and floating joints have the
// error of the frame alone.
struct JointError {
  double position = 0.0, slide = 0.0;
  PlaceError frame;
};

// What a body stands on that does not move: its errors of place are also those of what it stands
// on.
struct RestingOn {
  enum class Kind : std::uint8_t { kWorld, kObject, kLink };
  Kind kind = Kind::kWorld;
  std::uint32_t object = 0;           // index into Scene::objects: a fixed one
  std::uint32_t robot = 0, link = 0;  // indices into Scene::robots and Robot::links

  bool operator==(const RestingOn&) const = default;
};

}  // namespace clearance
