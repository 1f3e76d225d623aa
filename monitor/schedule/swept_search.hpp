// Bounds of the smallest distance of two parts between two ticks. They follow from queries at a few
// instants and from the largest motion between those instants. README.md here has the proof.
#pragma once

#include <array>

#include "monitor/bodies/interpolated_motion.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/schedule/swept_bounds.hpp"

namespace clearance {

class SweptSearch {
 public:
  static constexpr std::uint32_t kLeastQueries = 2;  // one at each end
  static constexpr std::uint32_t kMostQueries = 24;

  // For the parts of `part_pair`, whose objects were known at the last tick.
  SweptSearch(std::uint32_t part_pair, const TickView& view) noexcept;

  // Queries further instants, always in the gap with the lowest bound, until `level` (m) is
  // decided. That is, the distance was never below it, or it was below at some instant. Ends
  // undecided when the budget is used up, after kMostQueries, or when the gap is too short to
  // divide.
  [[nodiscard]] SweptBounds decide(double level, Budget& budget) noexcept;

 private:
  // One query.
  struct Instant {
    double s = 0.0;  // share of the motion
    double lower = -kInfinity, upper = kInfinity;
    // The motion is that of one object relative to the other. These two are in the frame of the
    // latter.
    // Towards the other; zero: no direction is known that separates them after more motion, too.
    Vec3 normal = Vec3::Zero();
    Vec3 centre = Vec3::Zero();  // of the other's sphere
  };
  // The time between two neighbouring instants.
  struct Gap {
    std::size_t before = 0;     // index of the earlier of the two
    double lower = -kInfinity;  // m
    double deepest = 0.5;       // the instant at which the distance may be that low, as a share of
                                // the gap
  };

  [[nodiscard]] Instant query_at(double s, Budget& budget) noexcept;
  [[nodiscard]] Gap gap_after(std::size_t before) const noexcept;
  [[nodiscard]] Gap lowest_gap() const noexcept;
  [[nodiscard]] double fall(const Instant& from, const Instant& to) const noexcept;
  void insert(const Instant& instant) noexcept;

  std::uint32_t part_pair_;
  CloudPairs* clouds_;  // null: no part is what a sensor sees
  PosedPart a_, b_;
  InterpolatedMotion motion_a_, motion_b_;
  double model_error_ = 0.0;  // m: PairTable::largest_error()
  bool from_b_ = false;       // A moves relative to B's object, not B relative to A's, because that
                              // motion is slower
  bool directed_ = false;  // a separating direction goes on separating bodies that only translate
  RelativeMotion relative_;
  double direction_error_ = 0.0;  // of a sphere centre's coordinate along a normal, m
  TrackingState tracking_;
  std::array<Instant, kMostQueries> instants_;
  std::size_t size_ = 0;
};

}  // namespace clearance
