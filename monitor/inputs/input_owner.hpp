// Who sends the poses of an object, or the positions of a joint: the source that the cell names,
// else the first one, until that one has been silent for long enough.
#pragma once

#include <algorithm>
#include <cstdint>

#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// A stamp that nobody can tell the age of is as old as any: a hundred years.
inline constexpr std::int64_t kForgottenNs = 3'155'760'000'000'000'000;

class InputOwner {
 public:
  InputOwner() = default;
  // Stated by the cell: no other takes over.
  explicit InputOwner(std::uint32_t source) noexcept : source_(source), is_stated_(true) {}

  // Whether what this source sends is to be refused; notes who it is. `age_limit_ns`: of the input.
  [[nodiscard]] bool refuses(std::uint32_t source, std::int64_t now_ns,
                             std::int64_t age_limit_ns) noexcept {
    constexpr std::int64_t kSilentNs = 1'000'000'000;  // then it no longer owns the input
    if (source == source_ || source_ == kNoSource) return false;
    if (!is_stated_ && elapsed(taken_ns_, now_ns) > std::max(age_limit_ns, kSilentNs)) return false;
    other_ = source;
    return true;
  }

  // What this source sends was taken into use.
  void take(std::uint32_t source, std::int64_t now_ns) noexcept {
    if (source != source_) other_ = kNoSource;
    source_ = source;
    taken_ns_ = now_ns;
  }

  // Nobody can say how long ago that was: it counts from now.
  void forget_age(std::int64_t now_ns) noexcept { taken_ns_ = now_ns; }

  [[nodiscard]] std::uint32_t source() const noexcept { return source_; }
  // The last one that was refused since it is not the owner; none since that took over.
  [[nodiscard]] std::uint32_t other_source() const noexcept { return other_; }

 private:
  std::uint32_t source_ = kNoSource;
  std::uint32_t other_ = kNoSource;
  std::int64_t taken_ns_ = 0;  // in the tick's time
  bool is_stated_ = false;
};

}  // namespace clearance
