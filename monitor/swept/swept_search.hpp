// How near did two parts come between two ticks? Bounds from queries at a few instants, and from
// how far the motion between those instants can go. README.md here has the proof.
#pragma once

#include <array>

#include "monitor/motion/interpolated_motion.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/swept/swept_bounds.hpp"

namespace clearance {

class SweptSearch {
 public:
  static constexpr std::uint32_t kLeastQueries = 2;  // one at each end
  static constexpr std::uint32_t kMostQueries = 24;

  // For the parts of `part_pair`, whose objects were known at the last tick.
  SweptSearch(std::uint32_t part_pair, const TickView& view) noexcept;

  // Queries further instants, always in the gap with the lowest bound, until `level`, m, is
  // decided: the distance was never below it, or it was at some instant. Ends undecided when the
  // budget does, after kMostQueries, or when the gap is too short to divide.
  [[nodiscard]] SweptBounds decide(double level, Budget& budget) noexcept;

 private:
  // One query.
  struct Instant {
    double s = 0.0;  // share of the motion
    double lower = -kInfinity, upper = kInfinity;
    // In the frame of the object from which the other is seen:
    Vec3 normal = Vec3::Zero();  // towards the other; zero: it need not separate after more motion
    Vec3 centre = Vec3::Zero();  // of the other's sphere
  };
  // The time between two neighbouring instants.
  struct Gap {
    std::size_t before = 0;     // index of the earlier of the two
    double lower = -kInfinity;  // m
    double deepest = 0.5;       // where the distance may be that low, as a share of the gap
  };

  [[nodiscard]] Instant query_at(double s, Budget& budget) noexcept;
  [[nodiscard]] Gap gap_after(std::size_t before) const noexcept;
  [[nodiscard]] Gap lowest_gap() const noexcept;
  [[nodiscard]] double fall(const Instant& from, const Instant& to) const noexcept;
  void insert(const Instant& instant) noexcept;

  PosedPart a_, b_;
  InterpolatedMotion motion_a_, motion_b_;
  bool from_b_ = false;    // A is seen from B's object, not B from A's, because that is slower
  bool directed_ = false;  // a separating direction goes on separating bodies that only translate
  RelativeMotion relative_;
  double direction_error_ = 0.0;  // of a sphere centre's coordinate along a normal, m
  TrackingState tracking_;
  std::array<Instant, kMostQueries> instants_;
  std::size_t size_ = 0;
};

}  // namespace clearance
