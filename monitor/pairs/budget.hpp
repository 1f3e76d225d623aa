// The distance queries that a tick may make, and those of them that are kept for a later stage.
#pragma once

#include <algorithm>
#include <cstdint>

#include "monitor/interface/invariant.hpp"

namespace clearance {

class Budget {
 public:
  constexpr explicit Budget(std::uint32_t queries) noexcept : left_(queries) {}

  // The number of queries that may be made now.
  [[nodiscard]] constexpr std::uint32_t left() const noexcept { return left_; }
  // Counts queries that have been made.
  constexpr void spend(std::uint32_t queries = 1) noexcept {
    CLEARANCE_INVARIANT(queries <= left_);
    left_ -= queries;
  }

  // Keeps this many queries, or all that are left, from the stages before release(), which takes
  // the returned number.
  [[nodiscard]] constexpr std::uint32_t reserve(std::uint32_t queries) noexcept {
    const std::uint32_t kept = std::min(queries, left_);
    left_ -= kept;
    return kept;
  }
  constexpr void release(std::uint32_t kept) noexcept { left_ += kept; }

 private:
  std::uint32_t left_;
};

}  // namespace clearance
