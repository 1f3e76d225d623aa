// The active pairs of pieces of two bodies, placed in A's frame: middles, radii and weights.
// Compiled once a vector width: see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_PLACED_PIECES) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_PLACED_PIECES
#undef CLEARANCE_CORE_PLACED_PIECES
#else
#define CLEARANCE_CORE_PLACED_PIECES
#endif

#include "core/curved/own_support-inl.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The arrays run along the pairs of `active`. `weight` is how much each counts, of sum 1; `apart`
// joins both support points along the direction that was looked at last.
struct PlacedPieces {
  HWY_INLINE PlacedPieces(const ConvexBody& of_a, const ConvexBody& of_b, const RelativePose4& pose,
                          ActivePieces& pieces)
      : a(of_a), b(of_b), a_from_b(pose), active(pieces) {}

  [[nodiscard]] HWY_INLINE std::size_t count() const { return active.count; }
  [[nodiscard]] HWY_INLINE SidePieces side(bool of_a) const {
    return {active.pieces.data(), weight, active.count, of_a ? &PiecePair::a : &PiecePair::b};
  }
  [[nodiscard]] HWY_INLINE bool has_flat() const {
    const PiecePair& first = active.pieces[0];
    return first.a >= first_flat(a) || first.b >= first_flat(b);
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
      active.pieces[i] = active.pieces[i + 1];
      middle[i] = middle[i + 1];
      radius_a[i] = radius_a[i + 1];
      radius_b[i] = radius_b[i + 1];
      apart[i] = apart[i + 1];
    }
    if (active.count == 1) weight[0] = 1.0;
  }
  // kNone: of this body, that of the heaviest pair.
  void add(std::int32_t of_a, std::int32_t of_b) {
    std::size_t most = 0, least = 0;
    for (std::size_t i = 1; i < active.count; ++i) {
      if (weight[i] > weight[most]) most = i;
      if (weight[i] < weight[least]) least = i;
    }
    PiecePair pieces = active.pieces[most];
    if (of_a != kNone) pieces.a = of_a;
    if (of_b != kNone) pieces.b = of_b;
    const std::size_t at = active.count < 3 ? active.count++ : least;
    active.pieces[at] = pieces;
    weight[at] = 0.0;
    place(at);
  }

  const ConvexBody &a, &b;
  const RelativePose4& a_from_b;
  ActivePieces& active;
  Vec4 middle[3], apart[3];
  double radius_a[3], radius_b[3], weight[3];

 private:
  // A piece's middle in the body's own frame, and its radius.
  struct Piece4 {
    Vec4 middle;
    double radius;
  };
  [[nodiscard]] static HWY_INLINE Piece4 piece(const ConvexBody& body, std::int32_t number) {
    const auto at = static_cast<std::size_t>(number);
    switch (body.curved.kind) {
      case CurvedShape::Kind::kNone:
        return {load3(body.anchors[at]), 0.0};
      case CurvedShape::Kind::kEllipsoid:
        return {spread(0.0), 1.0};
      case CurvedShape::Kind::kTruncatedCone:
        break;
    }
    const Disc& disc = body.curved.discs[at];
    return {vec4(0.0, 0.0, disc.height, 0.0), disc.radius};
  }
  HWY_INLINE void place(std::size_t i) {
    const Piece4 of_a = piece(a, active.pieces[i].a), of_b = piece(b, active.pieces[i].b);
    middle[i] = point_to_a(a_from_b, of_b.middle) - of_a.middle;
    radius_a[i] = of_a.radius;
    radius_b[i] = of_b.radius;
  }
};

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
