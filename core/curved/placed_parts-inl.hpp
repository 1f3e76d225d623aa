// The active pairs of parts of two bodies, placed in A's frame: middles, radii and weights.
// Compiled once per vector width: see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_PLACED_PARTS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_PLACED_PARTS
#undef CLEARANCE_CORE_PLACED_PARTS
#else
#define CLEARANCE_CORE_PLACED_PARTS
#endif

#include "core/curved/body_support-inl.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The arrays are indexed by the pairs of `active`, with room for another one behind them. The
// weights have sum 1. `gap` is the vector from A's to B's support point along the direction that
// was evaluated last.
struct PlacedParts {
  HWY_INLINE PlacedParts(const Side& side_a, const Side& side_b, const RelativePose4& pose,
                         ActiveParts& parts)
      : a(side_a), b(side_b), a_from_b(pose), active(parts) {}

  [[nodiscard]] HWY_INLINE std::size_t count() const { return active.count; }
  [[nodiscard]] HWY_INLINE SideParts side(bool is_a) const {
    return {active.pairs.data(), weight, active.count, is_a ? &PartPair::a : &PartPair::b};
  }
  [[nodiscard]] HWY_INLINE bool has_planar_face() const {
    const PartPair& first = active.pairs[0];
    return first.a >= first_planar_face(a.body) || first.b >= first_planar_face(b.body);
  }
  HWY_INLINE void place_all() {
    place(0);
    weight[0] = 1.0;
    if (HWY_LIKELY(active.count == 1)) return;
    weight[0] = 1.0 / static_cast<double>(active.count);
    for (std::size_t i = 1; i < active.count; ++i) {
      place(i);
      weight[i] = weight[0];
    }
  }
  void drop(std::size_t at) {
    --active.count;
    for (std::size_t i = at; i < active.count; ++i) {
      active.pairs[i] = active.pairs[i + 1];
      middle[i] = middle[i + 1];
      radius_a[i] = radius_a[i + 1];
      radius_b[i] = radius_b[i + 1];
      gap[i] = gap[i + 1];
    }
    if (active.count == 1) weight[0] = 1.0;
  }
  [[nodiscard]] HWY_INLINE bool has(const PartPair& pair) const {
    for (std::size_t i = 0; i < active.count; ++i) {
      if (active.pairs[i] == pair) return true;
    }
    return false;
  }
  // Places a pair that is not yet active behind the active ones.
  HWY_INLINE void place_behind(const PartPair& pair) { place(active.count, pair); }
  // The pair that was placed behind the active ones becomes active, without weight. `instead_of`: a
  // pair that it replaces, or the number of active ones.
  void add(const PartPair& pair, std::size_t instead_of) {
    middle[instead_of] = middle[active.count];
    radius_a[instead_of] = radius_a[active.count];
    radius_b[instead_of] = radius_b[active.count];
    weight[instead_of] = 0.0;
    active.pairs[instead_of] = pair;
    if (instead_of == active.count) ++active.count;
  }

  const Side &a, &b;
  const RelativePose4& a_from_b;
  ActiveParts& active;
  Vec4 middle[4], gap[4];
  double radius_a[4], radius_b[4], weight[4];

 private:
  // A part's middle in the body's frame, and its radius.
  struct Part {
    Vec4 middle;
    double radius;
  };
  [[nodiscard]] static HWY_INLINE Part part(const Side& side, std::int32_t number) {
    if (!side.is_round()) {
      return {load3(side.body.anchors[static_cast<std::size_t>(number)]), 0.0};
    }
    if (side.round.count == 1) return {spread(0.0), 1.0};
    const Disc& disc = side.round.parts[number];
    return {vec4(0.0, 0.0, disc.height, 0.0), disc.radius};
  }
  HWY_INLINE void place(std::size_t i) { place(i, active.pairs[i]); }
  HWY_INLINE void place(std::size_t i, const PartPair& pair) {
    const Part part_a = part(a, pair.a), part_b = part(b, pair.b);
    middle[i] = point_to_a(a_from_b, part_b.middle) - part_a.middle;
    radius_a[i] = part_a.radius;
    radius_b[i] = part_b.radius;
  }
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
