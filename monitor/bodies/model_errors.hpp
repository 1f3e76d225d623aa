// The stated errors of the model in the postures of a tick: how much nearer two parts may be than
// the model says (config/scene/stated_errors.hpp has the tree of their sources).
//
// A source within its bounds e displaces a point x by e (z x (x - o)) where it rotates about an
// axis z through o, by any vector of length e where it shifts, and by w x (x - o), |w| <= e, where
// it rotates about any axis. Along a unit direction n that separates two bodies, the gap loses at
// most the greatest sum of these displacements over the points of one body, less the depth of each
// point behind the plane that touches the body there. It suffices to look at vertices, since the
// sum is convex in x. What is left is of second order: at most the sum of all angles times the
// displacement.
#pragma once

#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/stated_errors.hpp"
#include "monitor/bodies/posed_part.hpp"
#include "monitor/bodies/robot_inputs.hpp"

namespace clearance {

// What stated errors do to the distance of two parts along a direction.
struct ErrorAlong {
  double loss = 0.0;   // m: the gap may be smaller or larger by this
  double drift = 0.0;  // m: since the last tick, `loss` has not been larger by more than this
};

class ModelErrors {
 public:
  explicit ModelErrors(const Scene& scene);

  [[nodiscard]] bool any() const noexcept { return stated_.any(); }
  [[nodiscard]] const StatedErrors& stated() const noexcept { return stated_; }

  // Places the sources. The objects and links are those of this tick.
  void place(std::span<const TrackedObject> objects, const RobotInputs& robots) noexcept;

  // The parts are posed; `normal` is in the world, unit, from a to b, and separates them or is the
  // direction of least overlap. `between`: of their objects. `moved`: no point of either has come
  // farther since the last tick, both added up, m.
  [[nodiscard]] ErrorAlong along(const PosedPart& a, const PosedPart& b, const Vec3& normal,
                                 const ErrorsBetween& between, double moved) const noexcept;

  // The loss by each source that carries one of the two objects, but not both, where `point`, in
  // the world, is a point of one of them; of first order. Calls add(source, metres).
  template <class Add>
  void each_share(std::uint32_t a, std::uint32_t b, const Vec3& point, const Vec3& normal,
                  Add&& add) const {
    const Line line(point, normal);
    const std::uint32_t common = stated_.between(a, b).common;
    for (const std::uint32_t object : {a, b}) {
      for (std::uint32_t s = stated_.source_of(object); s != common; s = parent_[s])
        add(s, stated_.sources()[s].translation + share(s, line));
    }
  }

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    stated_.each_constant(visit);
    visit("parents of errors", parent_);
    visit("rotations of errors", rotations_);
  }

 private:
  // The line through a point along a unit direction, and its moment.
  struct Line {
    Vec3 along, moment;
    Line(const Vec3& point, const Vec3& direction) noexcept
        : along(direction), moment(point.cross(direction)) {}
  };
  // A source in the world: the line about which it turns.
  struct alignas(64) Screw {
    Vec3 axis = Vec3::Zero(), moment = Vec3::Zero();  // unit; origin x axis, with the other sign
    double turn = 0.0, slide = 0.0;                   // rad, m
  };
  // Sums over a source and all those that carry it.
  struct Sums {
    double translation = 0.0, slide = 0.0, angle = 0.0;  // m, m, rad
    double length = 0.0;                                 // of the path over their origins, m
    double drift_shift = 0.0, drift_turn = 0.0;  // of angle x motion since the last tick: m, rad
    bool is_known = true;                        // all have a place
  };
  // The sums of what carries one of two objects, but not both.
  [[nodiscard]] Sums sums_between(std::uint32_t source, std::uint32_t common) const noexcept;
  [[nodiscard]] double share(std::uint32_t source, const Line& line) const noexcept;
  [[nodiscard]] double shares(std::uint32_t tip, std::uint32_t common,
                              const Line& line) const noexcept;

  // The two chains of a query.
  struct Chains;
  [[nodiscard]] double shares(const Chains& chains, const Line& line) const noexcept;
  [[nodiscard]] double most_on(const PosedPart& part, const Vec3& towards, const Chains& chains,
                               Vec3& at, bool& is_pointed) const noexcept;
  [[nodiscard]] double most_on_vertices(const PosedPart& part, const Vec3& towards,
                                        const Chains& chains) const noexcept;

  StatedErrors stated_;
  // By source.
  std::vector<std::uint32_t> parent_;
  std::vector<Screw> screws_;
  std::vector<Vec3> origins_;
  std::vector<Eigen::Quaterniond> turns_;  // of what carries it
  std::vector<double> rotations_;          // rad
  std::vector<Sums> sums_;
  bool any_rotation_ = false;
  double farthest_ = 0.0;  // the largest coordinate of an origin, m
};

}  // namespace clearance
