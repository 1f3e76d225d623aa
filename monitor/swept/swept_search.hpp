// How near did two parts come between two ticks? From queries at a few instants of the way, and
// what the motion between those allows. README.md here.
#pragma once

#include <array>

#include "monitor/motion/interpolated_motion.hpp"
#include "monitor/pairs/evaluate_pair.hpp"

namespace clearance {

struct SweptBounds {
  double lower = -kInfinity;  // at every instant, m
  double upper = kInfinity;   // at some instant, m
};

class SweptSearch {
 public:
  static constexpr std::uint32_t kLeastQueries = 2;  // with fewer nothing can be told
  static constexpr std::uint32_t kMostQueries = 24;

  // The parts of `part_pair`, whose objects were known at the last tick.
  SweptSearch(std::uint32_t part_pair, const Evaluation& evaluation) noexcept;

  // Looks closer, always where least is known, until `level` is decided, m: the parts were at least
  // that far apart all the time, or nearer at some instant; or until the budget ends, or looking
  // closer is no use.
  [[nodiscard]] SweptBounds decide(double level, Evaluation& evaluation) noexcept;

 private:
  // What a query has told.
  struct Instant {
    double s = 0.0;  // of the way
    double lower = -kInfinity, upper = kInfinity;
    // In the frame of the object that the other is seen from:
    Vec3 normal = Vec3::Zero();  // towards the other; zero: does not separate what moves on
    Vec3 middle = Vec3::Zero();  // of the other's sphere
  };
  // What lies between two neighbours of those.
  struct Gap {
    std::size_t before = 0;     // instants_[before] and the next
    double lower = -kInfinity;  // m
    double deepest = 0.5;       // where that may be, of the gap
  };

  [[nodiscard]] Instant look(double s, Evaluation& evaluation) noexcept;
  [[nodiscard]] Gap gap_after(std::size_t before) const noexcept;
  [[nodiscard]] Gap lowest_gap() const noexcept;
  [[nodiscard]] double fall(const Instant& from, const Instant& to) const noexcept;
  void insert(const Instant& instant) noexcept;

  PosedPart a_, b_;
  InterpolatedMotion motion_a_, motion_b_;
  bool from_b_ = false;    // A is seen from B's object, not B from A's: the slower of the two
  bool directed_ = false;  // a separating direction goes on separating bodies that only shift
  RelativeMotion relative_;
  double direction_error_ = 0.0;  // of a middle's place along a normal, m
  TrackingState tracking_;
  std::array<Instant, kMostQueries> instants_;
  std::size_t size_ = 0;
};

}  // namespace clearance
