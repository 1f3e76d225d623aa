#include "core/query_tables.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "core/body_tables.hpp"
#include "core/convex_body.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

void add_outgoing(ConvexBody& body) {
  body.outgoing.resize(body.vertex_edges.size());
  for (const Vertex& vertex : body.vertices) {
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const EdgeUse& use = body.vertex_edges[vertex.first_edge + i];
      const Vec3& direction = body.edges[use.edge].direction;
      body.set_outgoing(vertex, i, use.side == 0 ? direction : Vec3(-direction));
    }
  }
}

// The vertices at the far ends of vertices' edges, and the facets on the far sides of facets'
// edges.
void add_neighbours(ConvexBody& body) {
  body.neighbours.clear();
  body.facets_beside.clear();
  for (const EdgeUse& use : body.vertex_edges) {
    body.neighbours.push_back(body.edges[use.edge].vertex[1 - use.side]);
  }
  for (const EdgeUse& use : body.facet_edges) {
    body.facets_beside.push_back(body.edges[use.edge].facet[1 - use.side]);
  }
}

// The least distance of a facet from the interior point, less its error. The error has 2 roundings
// of the normal, 3 of the product and 1 of the difference. Users add the radius to a product, which
// takes 2 more.
double inner_radius(const ConvexBody& body) {
  constexpr double kRoundings = 16 * kUlp;
  if (!body.bounded() || body.facets.empty()) return 0.0;
  double nearest = kInfinity;
  for (const Facet& facet : body.facets) {
    nearest = std::min(nearest, facet.offset - facet.normal.dot(body.interior));
  }
  return std::max(0.0, nearest - kRoundings * body.bounding_radius - body.position_error);
}

// Writes the sides of each facet, and limits across the ends of those sides that meet the next one
// at a sharp angle.
void add_facet_limits(ConvexBody& body) {
  body.facet_limits.resize(body.facet_edges.size());
  for (const Facet& facet : body.facets) {
    for (std::int32_t i = 0; i < facet.limits; ++i) {
      const EdgeUse& use = body.facet_edges[facet.first_side + i];
      const Edge& edge = body.edges[use.edge];
      if (i < facet.sides) {
        const Vec3 inward = edge.inward.row(use.side);
        body.set_limit(facet, i, {inward, inward.dot(edge.point)});
      } else {
        const Vec3 back = use.side == 0 ? Vec3(-edge.direction) : edge.direction;
        body.set_limit(facet, i, {back, back.dot(body.anchors[edge.vertex[1 - use.side]])});
      }
    }
  }
}

// Normals and offsets by component, as the facet scans of core/penetration read them.
void add_planes(ConvexBody& body) {
  const auto count = static_cast<std::int32_t>(body.facets.size());
  body.planes.resize(body.facets.size());
  for (std::int32_t i = 0; i < count; ++i) {
    for (std::int32_t k = 0; k < 3; ++k) {
      body.planes.set(count, i, k, body.facets[i].normal[k]);
    }
    body.planes.set(count, i, 3, body.facets[i].offset);
  }
}

// Rays and an orthonormal basis of the lineality space (Gram and Schmidt). A line is a new
// direction if more than half of it is orthogonal to the lines before it. The remainder that
// rounding leaves of other lines is smaller.
void sort_rays(const ConvexBody& body, RecessionCone& out) {
  for (const Ray& ray : body.rays) {
    if (!ray.is_line) {
      out.rays.push_back(ray.exact ? Vec3(ray.direction.normalized()) : ray.direction);
    } else if (out.line_count < out.lines.size()) {
      const Vec3 rest = out.across_lines(ray.direction.normalized());
      if (rest.norm() > 0.5) out.lines[out.line_count++] = rest.normalized();
    }
  }
}

// Two directions are tried. The first is against the sum of the facets' normals: no ray leads out
// of a facet, and only lines run along all facets. The second is the sum of the rays, which is good
// for slender cones; one of many rays may be orthogonal to it.
double least_part(const RecessionCone& of, const Vec3& against_normals) {
  Vec3 along = Vec3::Zero();
  for (const Vec3& ray : of.rays) along += ray;
  double most = -kInfinity;
  for (const Vec3& sum : {against_normals, along}) {
    const Vec3 direction = of.across_lines(sum).normalized();
    double least = kInfinity;
    for (const Vec3& ray : of.rays) least = std::min(least, direction.dot(ray));
    most = std::max(most, least);
  }
  return most - kSlopeError;
}

// Against the sum of all normals, if it leads away from each by more than rounding.
Vec3 inwards(const ConvexBody& body, const Vec3& against_normals) {
  constexpr double kAway = 0x1p-20;
  const Vec3 direction = against_normals.normalized();
  const bool away = std::all_of(body.facets.begin(), body.facets.end(), [&](const Facet& facet) {
    return facet.normal.dot(direction) < -kAway;
  });
  return away ? direction : Vec3(Vec3::Zero());
}

void add_recession_cone(ConvexBody& body) {
  body.recession_cone = {};
  if (body.bounded()) return;
  sort_rays(body, body.recession_cone);
  Vec3 against_normals = Vec3::Zero();
  for (const Facet& facet : body.facets) against_normals -= facet.normal;
  body.recession_cone.least = least_part(body.recession_cone, against_normals);
  body.recession_cone.inwards = inwards(body, against_normals);
}

// The facet across an axis in this direction; kNone: there is none.
std::int32_t facet_across(const ConvexBody& body, int axis, bool negative) {
  const Vec3 normal = (negative ? -1.0 : 1.0) * Vec3::Unit(axis);
  for (std::size_t i = 0; i < body.facets.size(); ++i) {
    if (body.facets[i].normal == normal) return static_cast<std::int32_t>(i);
  }
  return kNone;
}

// The feature of the body that lies in all of these facets.
std::int32_t common_feature(const ConvexBody& body, const std::vector<std::int32_t>& facets) {
  if (facets.size() == 1) return facets.front();
  const auto is_beside = [&](std::int32_t edge, std::int32_t facet) {
    return body.edges[edge].facet[0] == facet || body.edges[edge].facet[1] == facet;
  };
  if (facets.size() == 2) {
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(body.edges.size()); ++i) {
      if (is_beside(i, facets[0]) && is_beside(i, facets[1])) return i;
    }
    return kNone;
  }
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(body.vertices.size()); ++i) {
    const Vertex& vertex = body.vertices[i];
    const bool in_all = std::all_of(facets.begin(), facets.end(), [&](std::int32_t facet) {
      for (std::int32_t k = 0; k < vertex.edges; ++k) {
        if (is_beside(body.vertex_edges[vertex.first_edge + k].edge, facet)) return true;
      }
      return false;
    });
    if (in_all) return i;
  }
  return kNone;
}

BoxFeatures box_features(const ConvexBody& body) {
  if (!body.bounded() || body.features != std::array<std::uint32_t, 3>{8, 12, 6}) return {};
  BoxFeatures box;
  std::int32_t across[3][2];
  for (int axis = 0; axis < 3; ++axis) {
    for (int negative = 0; negative < 2; ++negative) {
      across[axis][negative] = facet_across(body, axis, negative == 1);
      if (across[axis][negative] == kNone) return {};
    }
    const double up = body.facets[across[axis][0]].offset;
    const double down = body.facets[across[axis][1]].offset;
    box.centre[axis] = 0.5 * (up - down);
    box.half[axis] = 0.5 * (up + down);
  }
  for (unsigned index = 1; index < box.farthest.size(); ++index) {
    std::vector<std::int32_t> facets;
    for (unsigned axis = 0; axis < 3; ++axis) {
      if ((index >> axis & 1U) != 0) facets.push_back(across[axis][index >> (3 + axis) & 1U]);
    }
    if (facets.empty()) continue;
    const std::int32_t feature = common_feature(body, facets);
    assert(feature != kNone);
    box.farthest[index] = static_cast<std::int8_t>(feature);
  }
  box.length = box.half.norm();
  return box;
}

// Frees the spare capacity of the tables, which no longer grow.
void release_spare_capacity(ConvexBody& body) {
  const auto release = [](auto&... tables) { (tables.shrink_to_fit(), ...); };
  release(body.facets, body.edges, body.vertices, body.facet_edges, body.vertex_edges, body.anchors,
          body.neighbours, body.facets_beside);
}

}  // namespace

void add_query_tables(ConvexBody& body) {
  assert(std::all_of(body.facets.begin(), body.facets.end(),
                     [](const Facet& facet) { return is_unit_or_unknown(facet.normal); }));
  const double radius = body.bounded() ? body.bounding_radius : 0.0;
  body.error_bound_as_a = kUlp * kUlpsOnA * radius + (body.position_error + kUnderflow);
  body.error_bound_as_b = kUlp * kUlpsOnB * radius + body.position_error;
  body.inner_radius = inner_radius(body);
  add_recession_cone(body);
  const auto count = [](const auto& all) { return static_cast<std::uint32_t>(all.size()); };
  body.features = {count(body.vertices), count(body.edges), count(body.facets)};
  body.box = box_features(body);
  add_outgoing(body);
  add_neighbours(body);
  add_facet_limits(body);
  add_planes(body);
  release_spare_capacity(body);
  if (body.vertices.empty()) return;
  for (int cell = 0; cell < StartTable::kCells; ++cell) {
    body.start.set(cell, support(body, StartTable::middle(cell).normalized()).anchor);
  }
}

std::size_t footprint(const ConvexBody& body) noexcept {
  std::size_t bytes = sizeof body;
  each_table(body, [&](const char*, const auto& table) { bytes += table.size_bytes(); });
  return bytes;
}

}  // namespace clearance
