// The certificate of an answer of the active-set iteration: a direction that separates the bodies
// by at least `lower` (weak duality, §3.2).
#pragma once

#include <array>
#include <cstdint>

#include "core/active_set/active_feature.hpp"
#include "core/model/error_bounds.hpp"

namespace clearance {

// A direction to try: unit up to rounding, frame A, from A towards B.
struct Separator {
  Vec3 normal;
  // The facet of A whose normal this is, or of B whose normal is the opposite: its offset is the
  // support value.
  std::int32_t facet_of_a = kNone, facet_of_b = kNone;
  // The normal is orthogonal to these edges of A and B.
  std::int32_t edge_of_a = kNone, edge_of_b = kNone;
};

class Separators {
 public:
  void add(const Separator& s) noexcept { items_[size_++] = s; }
  [[nodiscard]] const Separator* begin() const noexcept { return items_.data(); }
  [[nodiscard]] const Separator* end() const noexcept { return items_.data() + size_; }

 private:
  std::array<Separator, 4> items_;
  std::size_t size_ = 0;
};

// The directions that the two active features suggest, the most accurate first.
[[nodiscard]] Separators separators(const ActiveFeature& a, const ActiveFeature& b) noexcept;

// min over B of n.x minus max over A of n.x, for |n| = 1 (m, frame A). The distance is at least
// this less p.error_bound. -infinity: an unbounded body leaves no bound. It is also -infinity if
// both bodies are unbounded and rounding cannot tell whether they leave one.
[[nodiscard]] double separation(const Separator& s, const ActiveFeature& a, const ActiveFeature& b,
                                const Precision& p) noexcept;

}  // namespace clearance
