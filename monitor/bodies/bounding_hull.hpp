// The reduced model of an object: one convex polyhedron of few facets around all its parts.
//
// It stands between the bounding sphere, which is the cheapest and loosest model, and the parts.
// Each of these has to be queried, or fetched from memory where it has many facets.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "core/enclosing_polyhedron.hpp"

namespace clearance {

using BoundingHull = std::shared_ptr<const ConvexBody>;

// An object of one part has a hull if that part has more facets than this: twice those of a hull.
inline constexpr std::size_t kFineFacets = 2 * EnclosingOptions().facets;

// The object's parts in its frame. The result points to the object, which must not be moved in
// memory.
[[nodiscard]] std::vector<PlacedShape> shapes_of(const Object& object);

// The hulls of a scene, by object. They do not change, so that a thread may read them while the
// scene's monitor ticks.
struct KnownHulls {
  std::span<const Object> objects = {};
  std::span<const BoundingHull> hulls = {};
};

// One hull an object, in its frame; null for an object of one simple part, or with an unbounded
// one. Objects of the same parts share a hull, with those of another scene, too: to find a hull
// takes milliseconds.
[[nodiscard]] std::vector<BoundingHull> bounding_hulls(const Scene& scene,
                                                       const KnownHulls& known = {});

}  // namespace clearance
