// Says which objects a tick must visit. An object at rest that no sample came for, and that is not
// late yet, stays as it is: it costs a comparison.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace clearance {

class VisitTimes {
 public:
  // Every object is due.
  explicit VisitTimes(std::size_t objects = 0) : due_ns_(objects, kNow) {}

  // The next tick visits this object.
  void visit(std::size_t object) noexcept { due_ns_[object] = kNow; }
  void visit_all() noexcept { std::ranges::fill(due_ns_, kNow); }
  // No tick at or before this time, in the tick's time, visits this object, unless visit() says so.
  void rest_until(std::size_t object, std::int64_t ns) noexcept { due_ns_[object] = ns; }
  // The same for an object that rests already. One that is due stays so.
  void rest_on_until(std::size_t object, std::int64_t ns, std::int64_t now_ns) noexcept {
    if (due_ns_[object] >= now_ns) due_ns_[object] = ns;
  }

  // Calls visit(object) for the objects from `first` to before `end` that are due. Many objects are
  // compared at once.
  template <class Visit>
  void each_due(std::size_t first, std::size_t end, std::int64_t now_ns,
                const Visit& visit) const noexcept {
    constexpr std::size_t kAtOnce = 8;
    for (; first + kAtOnce <= end; first += kAtOnce) {
      bool any = false;
      for (std::size_t k = 0; k < kAtOnce; ++k) any |= due_ns_[first + k] < now_ns;
      for (std::size_t k = 0; any && k < kAtOnce; ++k) {
        if (due_ns_[first + k] < now_ns) visit(first + k);
      }
    }
    for (; first < end; ++first) {
      if (due_ns_[first] < now_ns) visit(first);
    }
  }

 private:
  static constexpr std::int64_t kNow = std::numeric_limits<std::int64_t>::min();

  std::vector<std::int64_t> due_ns_;  // by object; the first tick after it visits the object
};

}  // namespace clearance
