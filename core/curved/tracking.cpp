#include "core/curved/tracking.hpp"

#include <cmath>

namespace clearance {
namespace {

bool are_usable(const ActivePieces& active, const ConvexPolyhedron& a,
                const ConvexPolyhedron& b) noexcept {
  if (active.count > active.pieces.size()) return false;
  for (std::size_t i = 0; i < active.count; ++i) {
    const PiecePair& pair = active.pieces[i];
    if (pair.a < 0 || pair.b < 0 || pair.a >= pieces_of(a) || pair.b >= pieces_of(b)) return false;
  }
  return true;
}

constexpr unsigned kBits = 21;
constexpr std::uint64_t kNumbers = std::uint64_t{1} << kBits;

// 2 p + q and 1, q being the piece of a curved body: of A if B is a polyhedron, else of B. 0: none.
std::uint64_t packed(const PiecePair& pair, bool b_is_curved) noexcept {
  const std::int32_t p = b_is_curved ? pair.a : pair.b, q = b_is_curved ? pair.b : pair.a;
  const std::uint64_t number =
      2 * static_cast<std::uint64_t>(p) + static_cast<std::uint64_t>(q) + 1;
  return number < kNumbers ? number : 0;
}
PiecePair unpacked(std::uint64_t number, bool b_is_curved) noexcept {
  const auto p = static_cast<std::int32_t>((number - 1) >> 1);
  const auto q = static_cast<std::int32_t>((number - 1) & 1);
  return b_is_curved ? PiecePair{p, q} : PiecePair{q, p};
}

}  // namespace

void forget_nonsense(CurvedTrackingState& state, const ConvexPolyhedron& a,
                     const ConvexPolyhedron& b) noexcept {
  if (!(std::abs(state.normal.squaredNorm() - 1.0) < 1e-9)) state.normal = Vec3::Zero();
  if (!are_usable(state.active, a, b)) state.active.count = 0;
}

CurvedTrackingState read(const TrackingState& state, const ConvexPolyhedron& a,
                         const ConvexPolyhedron& b) noexcept {
  CurvedTrackingState found;
  if (state.a.kind != FeatureKind::kDirection) return found;
  found.normal = state.a.point;
  const auto bits = [](std::int32_t half) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(half));
  };
  const std::uint64_t all = bits(state.b.feature) << 32 | bits(state.a.feature);
  for (unsigned i = 0; i < found.active.pieces.size(); ++i) {
    const std::uint64_t number = (all >> (i * kBits)) % kNumbers;
    if (number == 0) continue;
    found.active.pieces[found.active.count++] = unpacked(number, b.is_curved());
  }
  forget_nonsense(found, a, b);
  return found;
}

void write(const CurvedTrackingState& from, const ConvexPolyhedron& a, const ConvexPolyhedron& b,
           TrackingState& state) noexcept {
  std::uint64_t all = 0;
  if (a.is_curved() || b.is_curved()) {
    for (unsigned i = 0; i < from.active.count; ++i) {
      all |= packed(from.active.pieces[i], b.is_curved()) << (i * kBits);
    }
  }
  const auto half = [](std::uint64_t bits) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
  };
  state.a = {FeatureKind::kDirection, false, half(all), from.normal};
  state.b = {FeatureKind::kDirection, false, half(all >> 32), from.own_point_on_b};
}

}  // namespace clearance
