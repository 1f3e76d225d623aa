// The stamps of the poses in use, side by side, and the oldest and the newest of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace clearance {

class PoseStamps {
 public:
  // The stamp of an object that is fixed or has no pose: later than any other.
  static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

  explicit PoseStamps(std::size_t objects = 0) : stamps_(objects, kNone) {}

  void set(std::size_t object, std::int64_t stamp_ns) noexcept {
    changed_ = changed_ || stamps_[object] != stamp_ns;
    stamps_[object] = stamp_ns;
  }
  // Finds the oldest and the newest stamp, if any has changed.
  void update() noexcept {
    if (!changed_) return;
    changed_ = false;
    oldest_ = kNone;
    newest_ = kEarliest;
    for (const std::int64_t stamp : stamps_) {
      oldest_ = std::min(oldest_, stamp);
      newest_ = std::max(newest_, stamp == kNone ? kEarliest : stamp);
    }
  }
  // At the last update(); 0: there is none.
  [[nodiscard]] std::int64_t oldest() const noexcept { return oldest_ == kNone ? 0 : oldest_; }
  [[nodiscard]] std::int64_t newest() const noexcept { return oldest_ == kNone ? 0 : newest_; }

 private:
  static constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();

  std::vector<std::int64_t> stamps_;  // by object
  std::int64_t oldest_ = kNone, newest_ = kEarliest;
  bool changed_ = false;
};

}  // namespace clearance
