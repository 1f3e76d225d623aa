#include "monitor/schedule/motion_wheel.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/interface/invariant.hpp"

namespace clearance {
namespace {

// A timer that is set for more is due at this displacement: larger than any cell, and within the
// widest ring.
constexpr double kFarthest = 512.0;  // m

std::int64_t units(double length) noexcept {
  return static_cast<std::int64_t>(std::floor(length / MotionWheels::kUnit));
}

}  // namespace

MotionWheels::MotionWheels(std::size_t objects, std::size_t pairs)
    : wheels_(objects), first_(objects * kLevels * kRing, kNoIndex), timers_(2 * pairs) {}

bool MotionWheels::set(std::uint32_t timer, std::uint32_t object, double displacement) noexcept {
  const double accumulated = wheels_[object].accumulated;
  const std::int64_t now = units(accumulated);
  const std::int64_t due = units(rounded_down(accumulated + std::min(displacement, kFarthest)));
  if (due <= now) return false;
  const auto width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(due - now)));
  int level = std::max(0, width - 3);
  if ((due >> level) - (now >> level) >= kRing) ++level;
  CLEARANCE_INVARIANT((due >> level) > (wheels_[object].done >> level));  // its bucket is to come
  const auto place = static_cast<std::uint32_t>((due >> level) & (kRing - 1));
  const std::uint32_t bucket =
      (object * kLevels + static_cast<std::uint32_t>(level)) * kRing + place;

  timers_[timer] = {.next = first_[bucket], .before = kHead | bucket};
  if (first_[bucket] != kNoIndex) timers_[first_[bucket]].before = timer;
  first_[bucket] = timer;
  return true;
}

void MotionWheels::cancel(std::uint32_t timer) noexcept {
  const Timer at = timers_[timer];
  if (at.before == kNotSet) return;
  if (at.before & kHead) {
    first_[at.before & ~kHead] = at.next;
  } else {
    timers_[at.before].next = at.next;
  }
  if (at.next != kNoIndex) timers_[at.next].before = at.before;
  timers_[timer] = {};
}

void MotionWheels::advance(std::uint32_t object, double by) noexcept {
  if (!(by > 0.0)) return;
  Wheel& wheel = wheels_[object];
  wheel.accumulated = rounded_up(wheel.accumulated + by);
  // take_due() looks at the narrowest rings first. Their line of memory is fetched meanwhile.
  __builtin_prefetch(&first_[object * kLevels * kRing]);
}

bool MotionWheels::take_due(std::uint32_t object, std::size_t most,
                            std::vector<std::uint32_t>& pairs) noexcept {
  Wheel& wheel = wheels_[object];
  const std::int64_t now = units(wheel.accumulated);
  for (std::uint32_t level = 0; level < kLevels; ++level) {
    const std::int64_t last = now >> level;
    const std::int64_t passed = std::min<std::int64_t>(last - (wheel.done >> level), kRing);
    if (passed == 0) break;  // nor has a wider bucket been passed
    const std::uint32_t ring = (object * kLevels + level) * kRing;
    for (std::int64_t bucket = last - passed + 1; bucket <= last; ++bucket) {
      const auto place = static_cast<std::uint32_t>(bucket & (kRing - 1));
      if (!empty_bucket(ring + place, most, pairs)) return false;
    }
  }
  CLEARANCE_INVARIANT(wheel.done <= now);  // what accumulates never decreases
  wheel.done = now;
  return true;
}

bool MotionWheels::empty_bucket(std::uint32_t bucket, std::size_t most,
                                std::vector<std::uint32_t>& pairs) noexcept {
  while (first_[bucket] != kNoIndex) {
    if (pairs.size() >= most) return false;
    const std::uint32_t timer = first_[bucket];
    cancel(timer);
    cancel(timer ^ 1u);
    pairs.push_back(timer / 2);
  }
  return true;
}

}  // namespace clearance
