// Coarser models of a polyhedron out of one simple shape each: box, rounded box, capsule, cylinder,
// ellipsoid, or a polyhedron of few facets.
//
// Each holds the body, rounding included, and says how far it reaches beyond it at most. Fitted in
// doubles and then enlarged until every vertex is inside by more than doubles can be wrong about;
// the error is certified by distance() afterwards, whatever the fit was like. Load time only:
// allocates, may take up to a second.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

enum class ModelKind : std::uint8_t {
  kSphere,
  kCapsule,
  kBox,
  kRoundedBox,
  kCylinder,
  kEllipsoid,
  kPolyhedron,
};
[[nodiscard]] const char* name(ModelKind kind) noexcept;

struct EnclosingModel {
  ModelKind kind = ModelKind::kPolyhedron;
  ConvexBody shape;
  Pose frame_from_shape;  // in the body's frame
  // No point of the model is farther than this from the body, m: certified. Off the least such
  // bound by less than 2 % of itself, and of cylinders by 1e-5 of their radius.
  double error = kInfinity;
};

// The smallest that a search over directions finds, by volume (of ellipsoids the smallest there
// is, to 1e-4: L. G. Khachiyan, "Rounding of polytopes in the real number model of computation",
// 1996). `body`: a bounded polyhedron that is solid and without a radius.
[[nodiscard]] EnclosingModel enclosing_sphere(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_capsule(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_box(const ConvexBody& body);
// Of those along the enclosing box, the one of least error.
[[nodiscard]] EnclosingModel enclosing_rounded_box(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_cylinder(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_ellipsoid(const ConvexBody& body);
// Of at most this many facets, at least 6.
[[nodiscard]] EnclosingModel enclosing_facets(const ConvexBody& body, std::size_t facets);

// All of these, with 8, 16, 32, ... facets while that is fewer than the body has; in this order.
[[nodiscard]] std::vector<EnclosingModel> enclosing_models(const ConvexBody& body);

// How far the model reaches beyond the body, at most, m.
[[nodiscard]] double certified_error(const EnclosingModel& model, const ConvexBody& body);

}  // namespace clearance
