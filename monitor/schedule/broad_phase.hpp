// The broad phase decides which pairs a tick can provably leave alone. BROAD_PHASE.md has the
// proof and the reasons.
//
// A pair is culled while its lower bound L, less the displacement of its objects since L was proved
// and less U, is at least H and Z. U is the unobserved motion of late objects, now and since the
// last tick. H is the horizon, which is no smaller than a certified minimum over all pairs. Z is
// the level that the pair's zones watch for. The pair has a timer on the motion wheels of both
// objects, and the allowance s above those levels is divided between the two. All other pairs are
// active, and updated in every tick, or wait (untouched_pairs.hpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/interface/invariant.hpp"
#include "monitor/pairs/pairs_by_object.hpp"
#include "monitor/pairs/tick_view.hpp"
#include "monitor/schedule/motion_wheel.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

class BroadPhase {
 public:
  // A pair is cheaper active when its allowance is less than kLeastAllowance, m, plus kLeastTicks
  // ticks of both objects' usual displacement. It would become active again within a few ticks.
  static constexpr double kLeastAllowance = 16.0 * MotionWheels::kUnit;  // 4 mm
  static constexpr double kLeastTicks = 4.0;

  // `urgent`: by object, m. A pair is active when its distance, or its distance less its zone
  // level, is below the sum of this value over its two objects. `left_out`: pairs that every tick
  // updates anyway, in ascending order. `most_activated`: how many pairs a tick may activate, half
  // of them by meeting for the first time. The others wait, and only waiting_lower() is known of
  // them.
  // The table must outlive it.
  BroadPhase(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
             const ZoneLevels& zone_levels, std::vector<double> urgent,
             std::span<const std::uint32_t> left_out, std::size_t most_activated);

  // Updates the timers by how the objects have moved. Afterwards activated() has the pairs whose
  // allowance may be used up, whose objects are new, or whose objects have made a discontinuity.
  // The bounds of pairs with a discontinuity are forgotten. Pointers to the tick's objects are
  // kept, so these must stay where they are in memory until the next tick. `changed`: at least the
  // objects that have moved, or whose unobserved motion is not what it was.
  void begin(const OpenTick& tick, std::span<const std::uint32_t> changed) noexcept;

  // Call this before begin() when an object has become absent. It forgets the object's pairs, and
  // activates them when the object is known again.
  void forget_object(std::uint32_t object, PairTable& table) noexcept;

  // Pairs that are activated and not decided about, in this tick's order.
  [[nodiscard]] std::span<const std::uint32_t> activated() const noexcept { return activated_; }
  void clear_activated() noexcept { activated_.clear(); }

  // Culls a pair whose lower bound L for the poses in use is `lower`, m. False: L is too near to
  // the pair's levels, or no horizon has been set.
  bool cull(std::uint32_t pair, double lower) noexcept;

  // Returns true when a pair with this lower bound, m, is neither the minimum nor in a zone now.
  [[nodiscard]] bool is_far(std::uint32_t pair, double lower) const noexcept;

  // Bounds of the pair's distance by its objects' bounding spheres, for the poses in use, m.
  [[nodiscard]] DistanceBounds by_spheres(std::uint32_t pair) noexcept;

  [[nodiscard]] double horizon() const noexcept { return horizon_; }
  // Sets the horizon, m; -infinity means none. Lowering it activates no pair. Raising it activates
  // the pairs whose allowance this uses up.
  void move_horizon(double to) noexcept;

  // W: the lower bound of all pairs that wait, for the poses in use, m. Infinity: no pair waits.
  [[nodiscard]] double waiting_lower() const noexcept;
  [[nodiscard]] bool any_waits() const noexcept { return overdue_ || !everyone_met(); }
  // True if all pairs of known objects have been activated once.
  [[nodiscard]] bool everyone_met() const noexcept { return met_ == arrived_.size(); }

  // The objects of a pair.
  struct Ends {
    std::uint32_t a, b;
  };
  [[nodiscard]] Ends ends(std::uint32_t pair) const noexcept {
    return {table_.entries[pair].object_a, table_.entries[pair].object_b};
  }
  // Fetches the memory of a pair that cull() will be asked about soon.
  void fetch(std::uint32_t pair) const noexcept {
    __builtin_prefetch(&table_.entries[pair], 1);
    wheels_.fetch(pair);
  }
  [[nodiscard]] bool left_out(std::uint32_t pair) const noexcept { return left_out_[pair] != 0; }
  [[nodiscard]] const PairsByObject& by_object() const noexcept { return by_object_; }

  // Returns true when the invariant holds for this pair, whose distance is at most `upper`, m: it
  // is not culled, or it may be.
  [[nodiscard]] bool may_be_culled(std::uint32_t pair, double upper) const noexcept;
  // Checks the invariant of a few culled pairs by the spheres around their objects. Successive
  // ticks check different pairs.
  void check_some() noexcept;

 private:
  // The place of an object in the order in which objects became known. Its pairs with objects that
  // came earlier are still to be activated.
  struct Arrival {
    std::uint32_t rank = ~0u;
    std::uint32_t met = 0;  // in its turn it met the objects of a lower rank than this
    [[nodiscard]] bool has_arrived() const noexcept { return rank != ~0u; }
  };
  static constexpr std::uint32_t kCheckedPerTick = kMoreInvariantsChecked ? 64 : 4;
  struct Body {
    BoundingSphere sphere;
    Sphere sphere_in_world;                // while `placed`
    const TrackedObject* state = nullptr;  // once it has arrived
    bool placed = false;
    bool fixed = false;
    bool forgotten = false;       // nothing is known of its pairs until it has a pose again
    bool idle = true;             // all its pairs are left out
    double may_have_moved = 0.0;  // m; from the last tick in which it was finite
    Arrival arrival;
  };

  void arrive(std::uint32_t object, const TrackedObject& state) noexcept;
  void jump(std::uint32_t object, PairTable& table) noexcept;
  void pair_arrivals(std::size_t most) noexcept;
  void take_due(std::span<const std::uint32_t> objects) noexcept;
  [[nodiscard]] double level_of(std::uint32_t pair) const noexcept;
  [[nodiscard]] double level(std::uint32_t pair, double horizon) const noexcept;
  [[nodiscard]] bool is_culled(std::uint32_t pair) const noexcept;
  void activate(std::uint32_t pair) noexcept;
  [[nodiscard]] const Sphere& sphere_of(Body& body) noexcept;

  const std::size_t most_activated_, most_met_;  // a tick
  std::vector<Body> bodies_;
  // By object, m a tick, smoothed. It divides allowances and proves nothing.
  std::vector<double> usual_displacement_;
  const PairTable& table_;
  LargeColumn<std::uint8_t> left_out_;  // by pair
  const ZoneLevels& zone_levels_;       // Z
  std::vector<double> urgent_;          // by object, m
  PairsByObject by_object_;
  MotionWheels wheels_;
  double horizon_ = -kInfinity;  // H, m
  std::vector<std::uint32_t> activated_;
  std::vector<std::uint32_t> busy_;      // objects with pairs that are not left out
  std::vector<std::uint32_t> advanced_;  // objects whose wheels have advanced in this tick
  std::vector<std::uint32_t> arrived_;   // objects in their order; met_ of them had their turn
  std::size_t met_ = 0, met_pairs_ = 0;
  double largest_advance_ = 0.0;  // of any wheel this tick, m
  bool overdue_ = false;          // timers that are due are still on the wheels
  double overdue_lower_ = 0.0;    // W: their pairs' distance is at least this, m
  std::uint32_t next_checked_ = 0;
};

}  // namespace clearance
