// Which pairs need no look this tick, provably? README.md here says why it is done like this.
//
// A pair is asleep while its lower bound, carried by what its two objects have really travelled,
// cannot be below the horizon (no smaller than the minimum over all pairs, if that is proved), and,
// counting what late ones may have moved unseen, neither is nor since the last tick has been below
// what a zone watches it for. It has
// a hook on the wake wheels of both objects; the slack above those levels is divided between the
// two. All other pairs are awake: looked at in every tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/broad_phase/motion_wheel.hpp"
#include "monitor/geometry/bounding_sphere.hpp"
#include "monitor/pairs/pair_table.hpp"

namespace clearance {

class BroadPhase {
 public:
  struct Levels {
    std::vector<double> zones;   // by pair, m: awake where it may be nearer; -infinity: no zone
    std::vector<double> urgent;  // by object, m: awake where nearer than this of both together
  };
  // `left_out`: pairs that somebody looks at anyway, in ascending order. `most_woken`: pairs that
  // may be woken a tick, half as many by meeting for the first time; the others wait, and pending()
  // says so.
  BroadPhase(const Scene& scene, const std::vector<PosedPart>& parts, Levels levels,
             std::span<const std::uint32_t> left_out, std::size_t most_woken);

  // Takes in how the objects have moved. Pairs whose slack may be used up, whose objects were seen
  // for the first time or have jumped, are in woken() afterwards. `objects` stay where they are
  // until the next tick. Bounds of pairs whose objects have jumped are forgotten.
  // `changed`: at least the objects that have moved, or may have moved farther unseen, or less.
  void begin(const std::vector<TrackedObject>& objects, std::span<const std::uint32_t> changed,
             PairTable& table) noexcept;

  // Woken and not decided about; in this tick's order.
  [[nodiscard]] std::span<const std::uint32_t> woken() const noexcept { return woken_; }
  void clear_woken() noexcept { woken_.clear(); }

  // Puts a pair to sleep whose lower bound for the poses in use is `lower`, m. False: that is too
  // near its levels, or no horizon has been set.
  bool sleep(std::uint32_t pair, double lower) noexcept;

  // Whether a pair that far apart, m, is out of question now: not the minimum, nor in a zone.
  [[nodiscard]] bool is_far(std::uint32_t pair, double lower) const noexcept;

  // The pair's distance as far as the enclosing balls tell, for the poses in use, m.
  [[nodiscard]] RowBounds by_balls(std::uint32_t pair) noexcept;

  [[nodiscard]] double horizon() const noexcept { return horizon_; }
  // Lowering is free; raising wakes the pairs that it overtakes. m; -infinity: not set.
  void move_horizon(double to) noexcept;

  // Some pairs had to wait, so that only pending_lower() is known of them, m, for the poses in use.
  [[nodiscard]] bool pending() const noexcept { return overdue_ || !everyone_met(); }
  [[nodiscard]] double pending_lower() const noexcept;
  // No pair waits to be looked at for the first time.
  [[nodiscard]] bool everyone_met() const noexcept { return met_ == arrived_.size(); }

  [[nodiscard]] bool left_out(std::uint32_t pair) const noexcept { return left_out_[pair] != 0; }
  // Left out or not.
  [[nodiscard]] std::span<const std::uint32_t> pairs_of(std::uint32_t object) const noexcept;

 private:
  // An object whose pairs have to be looked at for the first time: with those that came before.
  struct Arrival {
    std::uint32_t rank = ~0u;
    std::uint32_t met = 0;  // in its turn it met those of lower rank than this
    bool here() const noexcept { return rank != ~0u; }
  };
  struct Body {
    BoundingSphere ball;
    Ball ball_in_world;                    // while `placed`
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
  void wake(std::uint32_t pair) noexcept;
  [[nodiscard]] const Ball& ball_of(Body& body) noexcept;

  const std::size_t most_woken_, most_met_;  // a tick
  std::vector<Body> bodies_;
  std::vector<double>
      usual_travel_;  // by object, m a tick, smoothed: divides slack, proves nothing
  std::vector<std::uint32_t> object_a_, object_b_;  // by pair
  std::vector<std::uint8_t> left_out_;              // by pair
  Levels levels_;
  std::vector<std::uint32_t> first_pair_, pairs_, others_;  // by object: pairs, and with whom
  MotionWheels wheels_;
  double horizon_ = -kInfinity;
  std::vector<std::uint32_t> woken_;
  std::vector<std::uint32_t> busy_;      // objects with pairs that are not left out
  std::vector<std::uint32_t> advanced_;  // those whose wheels have turned in this tick
  std::vector<std::uint32_t> arrived_;   // objects, in order; those before met_ had their turn
  std::size_t met_ = 0, met_pairs_ = 0;
  double farthest_travel_ = 0.0;  // of any wheel this tick, m
  bool overdue_ = false;          // hooks that are due are still on the wheels
  double overdue_lower_ = 0.0;    // their pairs' distance is at least this, m
};

}  // namespace clearance
