// Coarser models of a polyhedron, each of one simple shape: box, rounded box, capsule, cylinder,
// ellipsoid, or a polyhedron of few facets.
//
// Each model holds the body, rounding included, and states the largest distance by which it exceeds
// the body. It is fitted in doubles and then enlarged until every vertex is inside by more than
// rounding. Afterwards distance() certifies the error, so that a poor fit costs accuracy only. A
// call allocates and may take up to a second.
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
  // Certified: no point of the model is farther than this from the body, m (certified_error.hpp).
  double error = kInfinity;
};

// The model of least volume that a search over directions finds. An ellipsoid's volume is within
// 1e-4 of the least (L. G. Khachiyan, "Rounding of polytopes in the real number model of
// computation", 1996). `body`: a bounded and solid polyhedron without a radius.
[[nodiscard]] EnclosingModel enclosing_sphere(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_capsule(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_box(const ConvexBody& body);
// Has the axes of the enclosing box and, among these, the least error.
[[nodiscard]] EnclosingModel enclosing_rounded_box(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_cylinder(const ConvexBody& body);
[[nodiscard]] EnclosingModel enclosing_ellipsoid(const ConvexBody& body);
// Has at most this many facets; `facets`: at least 6.
[[nodiscard]] EnclosingModel enclosing_facets(const ConvexBody& body, std::size_t facets);

// All models above in this order. Polyhedra have 8, 16, 32, ... facets, fewer than the body has.
[[nodiscard]] std::vector<EnclosingModel> enclosing_models(const ConvexBody& body);

}  // namespace clearance
