#include "core/dqp3.hpp"

#include "core/alpha.hpp"
#include "core/delta.hpp"
#include "core/lambda.hpp"

namespace clearance {
namespace {

// Far above the longest walk of the corpus.
constexpr std::uint16_t kIterations = 1000;

// A rate this small, relative to the distance, is the rounding of unit vectors.
constexpr double kNoRate = 0x1p-50;

// One step of both points towards `to`. Each goes as far as its own facets allow (§3.4.1); where
// that would take them apart, both go the same fraction of the way, which cannot. True if nothing
// blocked.
bool step(ActiveSide& a, ActiveSide& b, const Delta& to) noexcept {
  const Vec3 move_a = to.a - a.common(), move_b = to.b - b.common();
  Alpha alpha_a = alpha(a, move_a), alpha_b = alpha(b, move_b);
  const bool free = alpha_a.blocking == kNone && alpha_b.blocking == kNone;
  if (!free) {
    const Vec3 between = b.common() - a.common();
    const Vec3 after = between + alpha_b.fraction * move_b - alpha_a.fraction * move_a;
    if (after.squaredNorm() > between.squaredNorm()) {
      if (alpha_a.fraction < alpha_b.fraction) {
        alpha_b = {alpha_a.fraction, kNone};
      } else if (alpha_b.fraction < alpha_a.fraction) {
        alpha_a = {alpha_b.fraction, kNone};
      }
    }
  }
  advance(a, move_a, alpha_a);
  advance(b, move_b, alpha_b);
  return free;
}

// Follows an edge or a facet, or leaves for the inside, from where x is.
void release(ActiveSide& side, const Lambda& l) noexcept { side.place(l.to, l.index, side.own()); }

}  // namespace

Dqp3Outcome dqp3(ActiveSide& a, ActiveSide& b, double contact) noexcept {
  Dqp3Outcome outcome;
  double closest2 = kInfinity;
  while (outcome.iterations < kIterations) {
    ++outcome.iterations;
    if (!step(a, b, delta(a, b))) continue;
    const Vec3 between = b.common() - a.common();
    const double distance2 = between.squaredNorm();
    if (distance2 <= contact * contact) return outcome.end = Dqp3End::kContact, outcome;
    if (!(distance2 < closest2)) return outcome.end = Dqp3End::kStalled, outcome;
    closest2 = distance2;
    const Lambda of_a = lambda(a, between), of_b = lambda(b, -between);
    const double best = std::max(of_a.rate, of_b.rate);
    if (!(best * best > kNoRate * kNoRate * distance2)) {
      return outcome.end = Dqp3End::kOptimal, outcome;
    }
    if (of_a.rate >= of_b.rate) {
      release(a, of_a);
    } else {
      release(b, of_b);
    }
  }
  return outcome;
}

}  // namespace clearance
