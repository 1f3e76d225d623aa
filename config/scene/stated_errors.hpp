// The stated errors of a cell's model, as bounds: how far bodies may be from where the cell, the
// descriptions of robots and the inputs place them.
//
// Each error belongs to a source: a joint, the base of a robot, or an object. A source turns and
// shifts all that it carries, by any amount within its bounds, about its place. So the sources form
// a tree, and what carries two bodies both does not change their distance.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "config/scene/place_error.hpp"
#include "core/vec.hpp"

namespace clearance {

struct Scene;
struct RobotBase;

// A node of the tree. Its place is a point of what carries it: an object, or a link of a robot.
struct ErrorSource {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t parent = kNone;  // index of an earlier source
  std::uint32_t depth = 1;       // sources from the root to this one
  // The joint that is the source: index into Robot::joints; kNone: the robot's base.
  std::uint32_t joint = kNone;
  bool on_link = false;
  std::uint32_t object = 0;           // else
  std::uint32_t robot = 0, link = 0;  // with on_link
  Vec3 origin = Vec3::Zero();         // in the frame of the object or link
  Vec3 axis = Vec3::UnitZ();          // unit, of `turn` and `slide`, likewise
  double translation = 0.0;           // m, in any direction
  double rotation = 0.0;              // rad, about any axis through the place
  double slide = 0.0, turn = 0.0;     // along and about the axis: m, rad

  // The largest angle by which it turns what it carries, rad.
  [[nodiscard]] double angle() const noexcept { return rotation + turn; }
};

// Names a source for people: "the joint 'elbow'", "the base of 'arm'", "the object 'table'".
[[nodiscard]] std::string text_of(const ErrorSource& source, const Scene& scene);

// rad: the largest sum over what carries a body. The bounds of second order hold up to here.
inline constexpr double kMostAngle = 0.25;

// What stated errors do to the distance of two objects.
struct ErrorsBetween {
  // In no posture do they change it by more than this, m. Infinity: there is no such bound, as for
  // a plane without end that may be tilted.
  double largest = 0.0;
  std::uint32_t common = ErrorSource::kNone;  // the last source that carries both
};

class StatedErrors {
 public:
  explicit StatedErrors(const Scene& scene);

  [[nodiscard]] bool any() const noexcept { return any_; }
  [[nodiscard]] const std::vector<ErrorSource>& sources() const noexcept { return sources_; }
  // The last source of the chain that carries the object; ErrorSource::kNone: none.
  [[nodiscard]] std::uint32_t source_of(std::uint32_t object) const noexcept {
    return objects_[object].source;
  }
  [[nodiscard]] std::uint32_t source_of_link(std::uint32_t robot,
                                             std::uint32_t link) const noexcept {
    return of_link_[robot][link];
  }
  // The error of the object's shape, m.
  [[nodiscard]] double shape_error(std::uint32_t object) const noexcept {
    return objects_[object].shape;
  }
  // The sum of the angles by which what carries the object may be turned, rad.
  [[nodiscard]] double angle_of(std::uint32_t object) const noexcept;
  // Says which object has angles that add up to more than kMostAngle; nothing: none.
  [[nodiscard]] std::optional<std::string> too_large_angle(const Scene& scene) const;
  [[nodiscard]] ErrorsBetween between(std::uint32_t a, std::uint32_t b) const noexcept;
  [[nodiscard]] double largest(std::uint32_t a, std::uint32_t b) const noexcept {
    return any_ ? between(a, b).largest : 0.0;
  }

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("sources of errors", sources_);
    visit("errors of objects", objects_);
    visit("errors of links", of_link_);
    visit("reach of errors", reach_);
  }

 private:
  struct OfObject {
    std::uint32_t source = ErrorSource::kNone;
    double shape = 0.0;     // m
    std::size_t first = 0;  // into reach_: one for each source of its chain, the last one first
  };

  class ChainWalk;

  void add_objects(const Scene& scene);
  void add_robots(const Scene& scene);
  void add_sensors(const Scene& scene);
  void measure(const Scene& scene);
  [[nodiscard]] std::uint32_t add(ErrorSource source, std::uint32_t parent);
  [[nodiscard]] std::uint32_t source_below(const RobotBase& base) const noexcept;
  [[nodiscard]] std::uint32_t source_below(const RestingOn& on) const noexcept;
  [[nodiscard]] std::uint32_t common_source(std::uint32_t a, std::uint32_t b) const noexcept;
  [[nodiscard]] double chain_error(const OfObject& of, std::uint32_t end,
                                   double& angle) const noexcept;

  bool any_ = false;
  std::vector<ErrorSource> sources_;
  std::vector<OfObject> objects_;
  std::vector<std::vector<std::uint32_t>> of_link_;  // by robot and link
  // No point of the object is farther from the place of the source, m.
  std::vector<double> reach_;
};

}  // namespace clearance
