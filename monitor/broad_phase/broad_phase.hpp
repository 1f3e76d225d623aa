// Which pairs need no look this tick, provably? README.md here says why it is done like this.
//
// A pair is culled while its lower bound L, less what its two objects have really moved since,
// cannot be below the horizon H (no smaller than the minimum over all pairs, if that is certified),
// and, counting what late ones may have moved unseen (U), neither is nor since the last tick has
// been below what a zone watches it for (Z). It has a timer on the motion wheels of both objects;
// the allowance s above those levels is divided between the two. All other pairs are active: looked
// at in every tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/broad_phase/motion_wheel.hpp"
#include "monitor/geometry/bounding_sphere.hpp"
#include "monitor/pairs/pair_table.hpp"
#include "monitor/pairs/pairs_by_object.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

class BroadPhase {
 public:
  // A pair with a smaller allowance than this, m, and so many ticks of both objects' usual
  // displacement is cheaper active: it would be back within a few ticks.
  static constexpr double kLeastAllowance = 16.0 * MotionWheels::kUnit;  // 4 mm
  static constexpr double kLeastTicks = 4.0;

  // `urgent`: by object, m: a pair nearer than that of both together, or that near to its zone
  // level, is active. `left_out`: pairs that are looked at anyway, in ascending order.
  // `most_activated`: pairs that may be activated a tick, half as many by meeting for the first
  // time; the others wait, and waiting_lower() is all that is known of them.
  BroadPhase(const Scene& scene, const std::vector<PosedPart>& parts, const ZoneLevels& zone_levels,
             std::vector<double> urgent, std::span<const std::uint32_t> left_out,
             std::size_t most_activated);

  // Takes in how the objects have moved. Pairs whose allowance may be used up, whose objects were
  // seen for the first time or have made a discontinuity, are in activated() afterwards. `objects`
  // stay where they are until the next tick. Bounds of pairs whose objects have made a
  // discontinuity are forgotten.
  // `changed`: at least the objects that have moved, or may have moved farther unseen, or less.
  void begin(const std::vector<TrackedObject>& objects, std::span<const std::uint32_t> changed,
             PairTable& table) noexcept;

  // Activated and not decided about; in this tick's order.
  [[nodiscard]] std::span<const std::uint32_t> activated() const noexcept { return activated_; }
  void clear_activated() noexcept { activated_.clear(); }

  // Culls a pair whose lower bound L for the poses in use is `lower`, m. False: that is too near
  // its levels, or no horizon has been set.
  bool cull(std::uint32_t pair, double lower) noexcept;

  // Whether a pair that far apart, m, is out of question now: not the minimum, nor in a zone.
  [[nodiscard]] bool is_far(std::uint32_t pair, double lower) const noexcept;

  // The pair's distance as far as the bounding spheres tell, for the poses in use, m.
  [[nodiscard]] DistanceBounds by_spheres(std::uint32_t pair) noexcept;

  [[nodiscard]] double horizon() const noexcept { return horizon_; }
  // Lowering is free; raising activates the pairs that it overtakes. m; -infinity: not set.
  void move_horizon(double to) noexcept;

  // Some pairs had to wait: W, all that is known of these, m, for the poses in use. Infinity: none.
  [[nodiscard]] double waiting_lower() const noexcept;
  [[nodiscard]] bool any_waits() const noexcept { return overdue_ || !everyone_met(); }
  // No pair waits to be looked at for the first time.
  [[nodiscard]] bool everyone_met() const noexcept { return met_ == arrived_.size(); }

  [[nodiscard]] bool left_out(std::uint32_t pair) const noexcept { return left_out_[pair] != 0; }
  [[nodiscard]] const PairsByObject& by_object() const noexcept { return by_object_; }

  // The invariant does not forbid that this pair, no farther apart than `upper`, m, is culled if it
  // is. And a look at a few of the culled pairs, others in each tick, by the spheres around their
  // objects.
  [[nodiscard]] bool may_be_culled(std::uint32_t pair, double upper) const noexcept;
  void check_some() noexcept;

 private:
  // An object whose pairs have to be looked at for the first time: with those that came before.
  struct Arrival {
    std::uint32_t rank = ~0u;
    std::uint32_t met = 0;  // in its turn it met those of lower rank than this
    bool here() const noexcept { return rank != ~0u; }
  };
  static constexpr std::uint32_t kCheckedPerTick = 4;
  struct Body {
    BoundingSphere sphere;
    Sphere sphere_in_world;                // while `placed`
    const TrackedObject* state = nullptr;  // once it has arrived
    bool placed = false;
    bool fixed = false;
    bool idle = true;             // all its pairs are left out
    double may_have_moved = 0.0;  // as of the last tick in which that was known, m
    Arrival arrival;
  };

  void arrive(std::uint32_t object, const TrackedObject& state) noexcept;
  void jump(std::uint32_t object, PairTable& table) noexcept;
  void meet_arrivals(std::size_t most) noexcept;
  void take_due(std::span<const std::uint32_t> objects) noexcept;
  [[nodiscard]] double level_of(std::uint32_t pair) const noexcept;
  [[nodiscard]] double zone_level(std::uint32_t pair) const noexcept;
  [[nodiscard]] bool is_culled(std::uint32_t pair) const noexcept;
  void activate(std::uint32_t pair) noexcept;
  [[nodiscard]] const Sphere& sphere_of(Body& body) noexcept;

  const std::size_t most_activated_, most_met_;  // a tick
  std::vector<Body> bodies_;
  // By object, m a tick, smoothed: divides allowances, proves nothing.
  std::vector<double> usual_displacement_;
  std::vector<std::uint32_t> object_a_, object_b_;  // by pair
  std::vector<std::uint8_t> left_out_;              // by pair
  const ZoneLevels& zone_levels_;                   // Z
  std::vector<double> urgent_;                      // by object, m
  PairsByObject by_object_;
  MotionWheels wheels_;
  double horizon_ = -kInfinity;  // H, m
  std::vector<std::uint32_t> activated_;
  std::vector<std::uint32_t> busy_;      // objects with pairs that are not left out
  std::vector<std::uint32_t> advanced_;  // those whose wheels have turned in this tick
  std::vector<std::uint32_t> arrived_;   // objects, in order; those before met_ had their turn
  std::size_t met_ = 0, met_pairs_ = 0;
  double largest_advance_ = 0.0;  // of any wheel this tick, m
  bool overdue_ = false;          // timers that are due are still on the wheels
  double overdue_lower_ = 0.0;    // W: their pairs' distance is at least this, m
  std::uint32_t next_checked_ = 0;
};

}  // namespace clearance
