// The distance queries that a tick may make, and those of them that are kept for a later step.
#pragma once

#include <algorithm>
#include <cstdint>

namespace clearance {

class Budget {
 public:
  constexpr explicit Budget(std::uint32_t queries) noexcept : left_(queries) {}

  // That may be made now.
  [[nodiscard]] constexpr std::uint32_t left() const noexcept { return left_; }
  // `queries` of these have been made.
  constexpr void spend(std::uint32_t queries = 1) noexcept { left_ -= queries; }

  // Keeps so many, as far as there are, from the steps up to release(), which takes what this
  // returns.
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
